// Which frames of a scene a command is to make.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scenes/loader/scene.h"

namespace pneuma::app {

/// Frames first..last, both included. Without a last one, to the end of the scene.
struct FrameRange {
  std::int64_t first = 0;
  std::optional<std::int64_t> last;
};

/// "30": the first 30 frames, 0 to 29. "10-20": frames 10 to 20. "10-": from 10 to the end.
/// Throws UsageError.
FrameRange parse_frames(const std::string& text);

struct Frames {
  std::int64_t first = 0;
  std::int64_t last = 0;
};

/// Throws UsageError when the scene has not got them.
Frames frames_of(const scenes::Scene& scene, const FrameRange& wanted);

}  // namespace pneuma::app

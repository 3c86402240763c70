// What `pneuma render` was asked to do.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/build_frame.h"

namespace pneuma::app {

/// Frames first..last, both drawn. Without a last one, to the end of the scene.
struct FrameRange {
  std::int64_t first = 0;
  std::optional<std::int64_t> last;
};

struct GridSize {
  int columns = 0;
  int rows = 0;
};

/// What to do when the folder already holds a run.
enum class ExistingRun { refuse, overwrite, resume };

struct RenderRequest {
  std::string scene;                   // a path or a name
  std::string out;                     // folder; empty: out/NAME
  std::vector<std::string> overrides;  // "PATH=VALUE"
  FrameRange frames;
  Pictures pictures;
  ExistingRun existing = ExistingRun::refuse;
  std::optional<GridSize> sheet;
  std::string video;  // file; empty: none
  int threads = 1;
  bool quiet = false;
  std::vector<std::string> command_line;
};

/// "30": the first 30 frames, 0 to 29. "10-20": frames 10 to 20. "10-": from 10 to the end.
/// Throws UsageError, as the others.
FrameRange parse_frames(const std::string& text);

/// "4x3". Each from 1 to `greatest`; `option` is named in messages.
GridSize parse_grid(const std::string& option, const std::string& text, int greatest);

}  // namespace pneuma::app

#include "app/terminal/frame_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/host/errors.h"
#include "app/terminal/number_text.h"

namespace pneuma::app {
namespace {

std::optional<FrameRange> read_frames(const std::string& text) {
  const std::size_t dash = text.find('-');
  const auto first = whole_number(std::string_view(text).substr(0, dash));
  if (!first) return std::nullopt;
  if (dash == std::string::npos) {
    if (*first < 1) return std::nullopt;
    return FrameRange{0, *first - 1};
  }
  if (dash + 1 == text.size()) return FrameRange{*first, std::nullopt};
  const auto last = whole_number(std::string_view(text).substr(dash + 1));
  if (!last || *last < *first) return std::nullopt;
  return FrameRange{*first, *last};
}

}  // namespace

FrameRange parse_frames(const std::string& text) {
  if (const auto range = read_frames(text)) return *range;
  throw UsageError(
      fmt::format("--frames: '{}' is not understood; write 30 for the first 30 frames, "
                  "10-20 for a part, 10- for all from 10 on",
                  text));
}

Frames frames_of(const scenes::Scene& scene, const FrameRange& wanted) {
  const std::int64_t end = scenes::frame_count(scene);
  const Frames frames{wanted.first, wanted.last.value_or(end)};
  if (frames.first > end || frames.last > end) {
    const auto last = static_cast<double>(std::max(frames.first, frames.last));
    throw UsageError(
        fmt::format("--frames: {} has the frames 0 to {}; more come from a longer run, "
                    "as with --set duration={:g}",
                    scene.name, end, std::ceil(last / static_cast<double>(end) * scene.duration)));
  }
  return frames;
}

}  // namespace pneuma::app

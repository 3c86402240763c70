#include "app/render_request.h"

#include <fmt/format.h>

#include <charconv>

#include "app/errors.h"

namespace pneuma::app {
namespace {

/// A whole number without a sign that is all of `text`.
std::optional<std::int64_t> number(std::string_view text) {
  std::int64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || text.starts_with('-')) return std::nullopt;
  return value;
}

std::optional<FrameRange> read_frames(const std::string& text) {
  const std::size_t dash = text.find('-');
  const auto first = number(std::string_view(text).substr(0, dash));
  if (!first) return std::nullopt;
  if (dash == std::string::npos) {
    if (*first < 1) return std::nullopt;
    return FrameRange{0, *first - 1};
  }
  if (dash + 1 == text.size()) return FrameRange{*first, std::nullopt};
  const auto last = number(std::string_view(text).substr(dash + 1));
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

GridSize parse_grid(const std::string& option, const std::string& text, int greatest) {
  const std::size_t cross = text.find('x');
  if (cross != std::string::npos) {
    const auto columns = number(std::string_view(text).substr(0, cross));
    const auto rows = number(std::string_view(text).substr(cross + 1));
    if (columns && rows && *columns >= 1 && *rows >= 1 && *columns <= greatest &&
        *rows <= greatest) {
      return {static_cast<int>(*columns), static_cast<int>(*rows)};
    }
  }
  throw UsageError(
      fmt::format("{}: '{}' is not understood; write two whole numbers from 1 to {} "
                  "with an x between them, such as 4x3",
                  option, text, greatest));
}

}  // namespace pneuma::app

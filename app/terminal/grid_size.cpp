#include "app/terminal/grid_size.h"

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

#include "app/host/errors.h"
#include "app/terminal/number_text.h"
#include "scenes/loader/scene.h"

namespace pneuma::app {
namespace {

struct Limits {
  int smallest, greatest;
};

/// `example`: such a value.
GridSize parse_two_numbers(const std::string& option, const std::string& text, Limits limits,
                           std::string_view example) {
  const auto is_within = [&](std::int64_t number) {
    return number >= limits.smallest && number <= limits.greatest;
  };
  const std::size_t cross = text.find('x');
  if (cross != std::string::npos) {
    const auto columns = whole_number(std::string_view(text).substr(0, cross));
    const auto rows = whole_number(std::string_view(text).substr(cross + 1));
    if (columns && rows && is_within(*columns) && is_within(*rows)) {
      return {static_cast<int>(*columns), static_cast<int>(*rows)};
    }
  }
  throw UsageError(
      fmt::format("{}: '{}' is not understood; write two whole numbers from {} to {} "
                  "with an x between them, such as {}",
                  option, text, limits.smallest, limits.greatest, example));
}

}  // namespace

GridSize parse_grid(const std::string& option, const std::string& text, int greatest) {
  return parse_two_numbers(option, text, {1, greatest}, "4x3");
}

void append_size(const std::string& size, std::vector<std::string>& overrides) {
  const GridSize grid = parse_two_numbers(
      "--size", size, {scenes::smallest_picture_side, scenes::greatest_picture_side}, "640x480");
  overrides.push_back(fmt::format("picture.width={}", grid.columns));
  overrides.push_back(fmt::format("picture.height={}", grid.rows));
}

}  // namespace pneuma::app

#include "app/render_request.h"

#include <fmt/format.h>

#include "app/errors.h"
#include "app/whole_number.h"

namespace pneuma::app {

GridSize parse_grid(const std::string& option, const std::string& text, int greatest) {
  const std::size_t cross = text.find('x');
  if (cross != std::string::npos) {
    const auto columns = whole_number(std::string_view(text).substr(0, cross));
    const auto rows = whole_number(std::string_view(text).substr(cross + 1));
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

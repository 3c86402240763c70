#include "scenes/loader/palette.h"

#include <array>

namespace pneuma::scenes {
namespace {

struct ShadeAndTint {
  const char* shade;
  const char* tint;
};

// Neighbours in the list differ in lightness and in blue against yellow, for scenes of few bodies.
constexpr std::array palette = {
    ShadeAndTint{"#c44e08", "#ee8347"},  // vermillion
    ShadeAndTint{"#0a5a9c", "#2f86c8"},  // blue
    ShadeAndTint{"#e09000", "#f5bd4f"},  // orange
    ShadeAndTint{"#007a5a", "#2aae87"},  // bluish green
    ShadeAndTint{"#5ab0e4", "#a0d4f3"},  // sky blue
    ShadeAndTint{"#b25a94", "#d994bf"},  // reddish purple
    ShadeAndTint{"#e3d53a", "#f4ec8e"},  // yellow
};

}  // namespace

std::size_t palette_size() { return palette.size(); }

std::vector<std::string> palette_colours(std::size_t index) {
  const ShadeAndTint& colours = palette[index % palette.size()];
  return {colours.shade, colours.tint};
}

}  // namespace pneuma::scenes

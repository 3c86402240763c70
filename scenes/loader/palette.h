// Colours of bodies whose scene names none.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pneuma::scenes {

/// How many bodies get colours of their own; beyond, they come again.
std::size_t palette_size();

/// Of the body with this index: a shade and a tint of one hue, so that a turning body is seen to
/// turn. The hues are those of Okabe and Ito (Color Universal Design, 2002), which people who
/// confuse red and green can tell apart.
std::vector<std::string> palette_colours(std::size_t index);

}  // namespace pneuma::scenes

// Pixels of a finished picture.
#pragma once

#include <cstdint>
#include <vector>

namespace pneuma::render {

/// 8-bit sRGB, three bytes a pixel, rows from top to bottom without padding.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
};

}  // namespace pneuma::render

// How far two pictures are apart.
#pragma once

#include "render/image/image.h"

namespace pneuma::render {

struct ImageDifference {
  int max = 0;                   // of any channel of any pixel, 0..255
  double fraction_beyond = 0.0;  // of pixels with a channel further apart than the threshold, 0..1
  double mean = 0.0;             // over all channels, 0..255
};

/// Throws std::invalid_argument when the sizes differ.
ImageDifference compare_images(const Image& a, const Image& b, int threshold);

/// Grey where the two agree, and the further from grey the further they are apart, eightfold.
/// Throws std::invalid_argument when the sizes differ.
Image difference_picture(const Image& a, const Image& b);

}  // namespace pneuma::render

#include "render/image/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

namespace pneuma::render {
namespace {

void require_same_size(const Image& a, const Image& b) {
  if (a.width == b.width && a.height == b.height && a.pixels.size() == b.pixels.size()) return;
  throw std::invalid_argument(fmt::format("pictures of {} x {} and {} x {} cannot be compared",
                                          a.width, a.height, b.width, b.height));
}

}  // namespace

ImageDifference compare_images(const Image& a, const Image& b, int threshold) {
  require_same_size(a, b);
  ImageDifference difference;
  if (a.pixels.empty()) return difference;
  std::size_t beyond = 0;
  double sum = 0.0;
  for (std::size_t pixel = 0; pixel < a.pixels.size(); pixel += 3) {
    int max = 0;
    for (std::size_t i = pixel; i < pixel + 3; ++i) {
      const int apart = std::abs(int{a.pixels[i]} - int{b.pixels[i]});
      max = std::max(max, apart);
      sum += apart;
    }
    difference.max = std::max(difference.max, max);
    if (max > threshold) ++beyond;
  }
  const auto channels = static_cast<double>(a.pixels.size());
  difference.fraction_beyond = 3.0 * static_cast<double>(beyond) / channels;
  difference.mean = sum / channels;
  return difference;
}

Image difference_picture(const Image& a, const Image& b) {
  require_same_size(a, b);
  Image picture = a;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const int apart = int{a.pixels[i]} - int{b.pixels[i]};
    picture.pixels[i] = static_cast<std::uint8_t>(std::clamp(128 + 8 * apart, 0, 255));
  }
  return picture;
}

}  // namespace pneuma::render

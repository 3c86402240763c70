#include "render/image/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pneuma::render {
namespace {

std::size_t channel_index(const Image& image, int x, int y) {
  return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
              static_cast<std::size_t>(x));
}

/// The pixels that a pixel of the smaller picture covers along one axis: whole ones, but for the
/// first and last, which count by the fraction of them that is covered.
struct Coverage {
  int first;
  std::vector<float> fractions;
};

std::vector<Coverage> coverage(int from_size, int to_size) {
  const double scale = static_cast<double>(from_size) / to_size;
  std::vector<Coverage> all;
  for (int i = 0; i < to_size; ++i) {
    const double begin = i * scale;
    const double end = std::min((i + 1) * scale, static_cast<double>(from_size));
    Coverage covered{static_cast<int>(begin), {}};
    for (int pixel = covered.first; pixel < end; ++pixel) {
      covered.fractions.push_back(static_cast<float>(
          (std::min(pixel + 1.0, end) - std::max<double>(pixel, begin)) / (end - begin)));
    }
    all.push_back(std::move(covered));
  }
  return all;
}

void paste(const Image& from, Image& to, int left, int top) {
  for (int y = 0; y < from.height; ++y) {
    const auto row = from.pixels.begin() + static_cast<std::ptrdiff_t>(channel_index(from, 0, y));
    std::copy(row, row + 3 * from.width,
              to.pixels.begin() + static_cast<std::ptrdiff_t>(channel_index(to, left, top + y)));
  }
}

}  // namespace

Image downscale(const Image& image, int width, int height) {
  if (width < 1 || height < 1 || width > image.width || height > image.height) {
    throw std::invalid_argument(fmt::format("downscale: {} x {} cannot become {} x {}", image.width,
                                            image.height, width, height));
  }
  Image small{width, height, {}};
  small.pixels.reserve(channel_index(small, 0, height));
  const std::vector<Coverage> columns = coverage(image.width, width);
  for (const Coverage& rows : coverage(image.height, height)) {
    for (const Coverage& across : columns) {
      for (std::size_t channel = 0; channel < 3; ++channel) {
        float sum = 0.0f;
        for (std::size_t j = 0; j < rows.fractions.size(); ++j) {
          std::size_t i =
              channel_index(image, across.first, rows.first + static_cast<int>(j)) + channel;
          for (const float fraction : across.fractions) {
            sum += rows.fractions[j] * fraction * static_cast<float>(image.pixels[i]);
            i += 3;
          }
        }
        small.pixels.push_back(static_cast<std::uint8_t>(std::lround(sum)));
      }
    }
  }
  return small;
}

Image contact_sheet(std::span<const Image> images, int columns, int rows, int width) {
  if (images.empty() || columns < 1 || rows < 1 ||
      images.size() > static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {
    throw std::invalid_argument(fmt::format("contact_sheet: {} pictures do not go into {} x {}",
                                            images.size(), columns, rows));
  }
  constexpr std::uint8_t paper = 250;
  const int margin = std::max(2, width / 320);
  int widest = 0;
  for (const Image& image : images) widest = std::max(widest, image.width);
  const int cell_width = std::min(widest, (width - margin * (columns + 1)) / columns);
  const double shape = static_cast<double>(images[0].height) / images[0].width;
  const int cell_height = static_cast<int>(std::lround(cell_width * shape));
  if (cell_width < 1 || cell_height < 1) {
    throw std::invalid_argument(
        fmt::format("contact_sheet: {} pixels are too few for {} columns", width, columns));
  }

  Image sheet{margin + columns * (cell_width + margin), margin + rows * (cell_height + margin), {}};
  sheet.pixels.assign(channel_index(sheet, 0, sheet.height), paper);
  for (std::size_t i = 0; i < images.size(); ++i) {
    const Image& image = images[i];
    const double scale = std::min({1.0, static_cast<double>(cell_width) / image.width,
                                   static_cast<double>(cell_height) / image.height});
    const Image small =
        downscale(image, std::max(1, static_cast<int>(std::lround(scale * image.width))),
                  std::max(1, static_cast<int>(std::lround(scale * image.height))));
    const int column = static_cast<int>(i) % columns;
    const int row = static_cast<int>(i) / columns;
    paste(small, sheet, margin + column * (cell_width + margin) + (cell_width - small.width) / 2,
          margin + row * (cell_height + margin) + (cell_height - small.height) / 2);
  }
  return sheet;
}

}  // namespace pneuma::render

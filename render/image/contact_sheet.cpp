#include "render/image/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "render/text/layout.h"

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

std::vector<TextLayout> lay_out_captions(const Font& font, std::span<const std::string> captions,
                                         int width) {
  const float size = std::clamp(static_cast<float>(width) / 20.0f, 9.0f, 16.0f);  // of an em
  std::vector<TextLayout> texts;
  for (const std::string& caption : captions) {
    texts.push_back(lay_out(font, caption, size, static_cast<float>(width)));
  }
  return texts;
}

/// Pixels.
int tallest(std::span<const TextLayout> texts) {
  float height = 0.0f;
  for (const TextLayout& text : texts) height = std::max(height, text.height);
  return static_cast<int>(std::ceil(height));
}

/// In black, as far as it lies within the picture.
void write_on(Image& image, const TextCoverage& text, int left, int top) {
  for (int y = 0; y < std::min(text.height, image.height - top); ++y) {
    for (int x = 0; x < std::min(text.width, image.width - left); ++x) {
      const std::size_t from = static_cast<std::size_t>(y) * static_cast<std::size_t>(text.width) +
                               static_cast<std::size_t>(x);
      for (std::size_t channel = 0; channel < 3; ++channel) {
        std::uint8_t& value = image.pixels[channel_index(image, left + x, top + y) + channel];
        value = static_cast<std::uint8_t>(value * (255 - text.values[from]) / 255);
      }
    }
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

Image contact_sheet(std::span<const Image> images, int columns, int rows, int width,
                    std::span<const std::string> captions) {
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

  Font font;
  const std::vector<TextLayout> texts = lay_out_captions(font, captions, cell_width);
  const int row_height = cell_height + margin + tallest(texts);
  Image sheet{margin + columns * (cell_width + margin), margin + rows * row_height, {}};
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
    const int left = margin + column * (cell_width + margin), top = margin + row * row_height;
    paste(small, sheet, left + (cell_width - small.width) / 2,
          top + (cell_height - small.height) / 2);
    if (i < texts.size()) write_on(sheet, cover(font, texts[i]), left, top + cell_height);
  }
  return sheet;
}

}  // namespace pneuma::render

#include "render/text/layout.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace pneuma::render {
namespace {

/// Sets one line from its left end on.
class LineSetter {
 public:
  LineSetter(const Font& font, float size) : font_(font), size_(size) {}

  /// How many fit: up to a space where there is one, else as many as go, at least one.
  std::size_t fitting(std::span<const char32_t> line, float most_width) const {
    std::size_t count = 0;
    bool full = false;
    set(line, [&](int, float, float end) {
      full = full || end > most_width;
      if (!full) ++count;
    });
    if (count == line.size()) return count;
    for (std::size_t space = count; space > 0; --space) {
      if (line[space] == U' ') return space;
    }
    return std::max<std::size_t>(count, 1);
  }

  template <class Visit>  // glyph, where it begins, where it ends
  void set(std::span<const char32_t> line, const Visit& visit) const {
    float pen = 0.0f;
    int before = -1;
    for (const char32_t point : line) {
      const int glyph = font_.glyph(point);
      if (before >= 0) pen += font_.kerning(before, glyph, size_);
      const float begin = pen;
      pen += font_.advance(glyph, size_);
      visit(glyph, begin, pen);
      before = glyph;
    }
  }

 private:
  const Font& font_;
  float size_;
};

/// Adds what of `bitmap` lies in the picture; glyphs that overlap do not add up beyond all.
void blend(const GlyphBitmap& bitmap, int x, int y, TextCoverage& into) {
  for (int row = 0; row < bitmap.height; ++row) {
    for (int column = 0; column < bitmap.width; ++column) {
      const int to_x = x + bitmap.left + column;
      const int to_y = y + bitmap.top + row;
      if (to_x < 0 || to_y < 0 || to_x >= into.width || to_y >= into.height) continue;
      const auto from = static_cast<std::size_t>(row * bitmap.width + column);
      std::uint8_t& to = into.values[static_cast<std::size_t>(to_y * into.width + to_x)];
      to = std::max(to, bitmap.coverage[from]);
    }
  }
}

}  // namespace

TextLayout lay_out(const Font& font, const std::string& text, float size, float most_width) {
  TextLayout result;
  result.size = size;
  const LineSetter setter(font, size);
  const std::vector<char32_t> points = code_points(text);
  std::span<const char32_t> left(points);
  bool more = !points.empty();
  while (more) {
    const auto end = std::ranges::find(left, U'\n') - left.begin();
    std::span<const char32_t> line = left.first(static_cast<std::size_t>(end));
    more = static_cast<std::size_t>(end) < left.size();
    left = left.subspan(static_cast<std::size_t>(end) + (more ? 1 : 0));
    do {
      const std::size_t count = setter.fitting(line, most_width);
      const float baseline = result.height + font.ascent(size);
      setter.set(line.first(count), [&](int glyph, float begin, float line_end) {
        result.glyphs.push_back({glyph, begin, baseline});
        result.width = std::max(result.width, line_end);
      });
      result.height += font.line_height(size);
      line = line.subspan(count);
      if (!line.empty() && line.front() == U' ') line = line.subspan(1);
    } while (!line.empty());
  }
  return result;
}

TextCoverage cover(Font& font, const TextLayout& layout) {
  TextCoverage result;
  result.width = static_cast<int>(std::ceil(layout.width)) + 2;
  result.height = static_cast<int>(std::ceil(layout.height)) + 2;
  result.values.resize(static_cast<std::size_t>(result.width) *
                       static_cast<std::size_t>(result.height));
  for (const PlacedGlyph& placed : layout.glyphs) {
    const auto parts = static_cast<int>(std::lround((placed.x + 1.0f) * Font::places));
    const int whole = parts / Font::places;
    const auto baseline = static_cast<int>(std::lround(placed.baseline)) + 1;
    blend(font.bitmap(placed.glyph, layout.size, parts % Font::places), whole, baseline, result);
  }
  return result;
}

}  // namespace pneuma::render

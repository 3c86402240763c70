// Glyphs of the font: how wide they are, and how much of each pixel they cover.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace pneuma::render {

/// Pixels that a glyph covers: 0 none of a pixel, 255 all of it.
struct GlyphBitmap {
  int left = 0;  // of the first column, from the pixel that holds the pen
  int top = 0;   // of the first row, from the base line; y grows downwards
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> coverage;  // row by row
};

/// The code points of UTF-8; what is not UTF-8 becomes U+FFFD, a byte each, and so do control
/// characters but the new line.
std::vector<char32_t> code_points(const std::string& text);

class Font {
 public:
  /// Subpixel placement: a glyph starts at one of so many places within a pixel.
  static constexpr int places = 4;

  Font();
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  /// 0 where the font has none: it is drawn as an empty box.
  int glyph(char32_t code_point) const;

  // In pixels, where an em has `size` of them.
  float advance(int glyph, float size) const;
  float kerning(int first, int second, float size) const;
  float ascent(float size) const;       // above the base line
  float line_height(float size) const;  // from one base line to the next

  /// `place`: by how many parts of a pixel the pen is right of the pixel's left side. The reference
  /// holds until the next call.
  const GlyphBitmap& bitmap(int glyph, float size, int place);

 private:
  struct File;
  using Key = std::tuple<int, float, int>;

  std::unique_ptr<File> file_;
  std::map<Key, GlyphBitmap> bitmaps_;
  std::size_t bytes_ = 0;  // of all bitmaps
};

}  // namespace pneuma::render

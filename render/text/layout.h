// A text as lines of placed glyphs, and as the pixels that they cover.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/text/font.h"

namespace pneuma::render {

struct PlacedGlyph {
  int glyph;
  float x;         // pixels from the left side of the text to the pen
  float baseline;  // pixels from its upper side
};

struct TextLayout {
  float size = 0.0f;  // pixels of an em
  std::vector<PlacedGlyph> glyphs;
  float width = 0.0f;   // pixels, of the longest line
  float height = 0.0f;  // pixels
};

/// Lines wider than `most_width` pixels go on in the next: at their last space that fits or, where
/// there is none, after the last glyph that fits, at least one. No other glyph than such a space is
/// left out.
TextLayout lay_out(const Font& font, const std::string& text, float size, float most_width);

/// How much of each pixel a text covers.
struct TextCoverage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> values;  // row by row, from the top
};

/// One pixel larger on each side than the layout, where letters lean over.
TextCoverage cover(Font& font, const TextLayout& layout);

}  // namespace pneuma::render

#include "render/text/font.h"

#include <stdexcept>

#include "render/text/font_bytes.h"

// Written without care for warnings; it is used as it is.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop

namespace pneuma::render {
namespace {

constexpr std::size_t most_bytes = std::size_t{8} << 20;  // of kept bitmaps
constexpr char32_t replacement = 0xFFFD;

/// How many bytes follow the first one of a character; -1 where none begins with it.
int continuation_bytes(unsigned char first) {
  if (first < 0x80) return 0;
  if ((first & 0xE0) == 0xC0) return 1;
  if ((first & 0xF0) == 0xE0) return 2;
  if ((first & 0xF8) == 0xF0) return 3;
  return -1;
}

}  // namespace

std::vector<char32_t> code_points(const std::string& text) {
  std::vector<char32_t> result;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i++]);
    const int more = continuation_bytes(first);
    if (more < 0 || i + static_cast<std::size_t>(more) > text.size()) {
      result.push_back(replacement);
      continue;
    }
    char32_t point = more == 0 ? first : static_cast<char32_t>(first & (0x3F >> more));
    bool whole = true;
    for (int k = 0; k < more; ++k) {
      const auto byte = static_cast<unsigned char>(text[i + static_cast<std::size_t>(k)]);
      whole = whole && (byte & 0xC0) == 0x80;
      point = (point << 6) | (byte & 0x3Fu);
    }
    if (whole) i += static_cast<std::size_t>(more);
    const bool printable = point == U'\n' || (point >= 0x20 && point != 0x7F);
    result.push_back(whole && printable ? point : replacement);
  }
  return result;
}

struct Font::File {
  stbtt_fontinfo info = {};

  float scale(float size) const { return stbtt_ScaleForMappingEmToPixels(&info, size); }
};

Font::Font() : file_(std::make_unique<File>()) {
  if (stbtt_InitFont(&file_->info, font_bytes().data(), 0) == 0) {
    throw std::logic_error("the embedded font cannot be read");
  }
}

Font::~Font() = default;

int Font::glyph(char32_t code_point) const {
  return stbtt_FindGlyphIndex(&file_->info, static_cast<int>(code_point));
}

float Font::advance(int glyph, float size) const {
  int width = 0;
  int bearing = 0;
  stbtt_GetGlyphHMetrics(&file_->info, glyph, &width, &bearing);
  return file_->scale(size) * static_cast<float>(width);
}

float Font::kerning(int first, int second, float size) const {
  return file_->scale(size) *
         static_cast<float>(stbtt_GetGlyphKernAdvance(&file_->info, first, second));
}

float Font::ascent(float size) const {
  int ascent = 0;
  int descent = 0;
  int gap = 0;
  stbtt_GetFontVMetrics(&file_->info, &ascent, &descent, &gap);
  return file_->scale(size) * static_cast<float>(ascent);
}

float Font::line_height(float size) const {
  int ascent = 0;
  int descent = 0;
  int gap = 0;
  stbtt_GetFontVMetrics(&file_->info, &ascent, &descent, &gap);
  return file_->scale(size) * static_cast<float>(ascent - descent + gap);
}

const GlyphBitmap& Font::bitmap(int glyph, float size, int place) {
  const auto known = bitmaps_.find({glyph, size, place});
  if (known != bitmaps_.end()) return known->second;
  if (bytes_ > most_bytes) {
    bitmaps_.clear();
    bytes_ = 0;
  }
  GlyphBitmap& made = bitmaps_[{glyph, size, place}];
  const float scale = file_->scale(size);
  const float shift = static_cast<float>(place) / places;
  int right = 0;
  int bottom = 0;
  stbtt_GetGlyphBitmapBoxSubpixel(&file_->info, glyph, scale, scale, shift, 0.0f, &made.left,
                                  &made.top, &right, &bottom);
  made.width = right - made.left;
  made.height = bottom - made.top;
  made.coverage.resize(static_cast<std::size_t>(made.width) *
                       static_cast<std::size_t>(made.height));
  if (!made.coverage.empty()) {
    stbtt_MakeGlyphBitmapSubpixel(&file_->info, made.coverage.data(), made.width, made.height,
                                  made.width, scale, scale, shift, 0.0f, glyph);
  }
  bytes_ += made.coverage.size();
  return made;
}

}  // namespace pneuma::render

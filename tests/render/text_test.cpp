// The font, and how texts are laid out and drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "render/passes/lettering.h"
#include "render/text/font.h"
#include "render/text/layout.h"
#include "tests/render/probe.h"

namespace pneuma::render {
namespace {

constexpr float no_limit = 1e6f;

double covered(const TextCoverage& coverage) {
  return std::accumulate(coverage.values.begin(), coverage.values.end(), 0.0) / 255.0;
}

TEST(CodePoints, AreThoseOfUtf8) {
  EXPECT_EQ(code_points("a\n"), (std::vector<char32_t>{U'a', U'\n'}));
  EXPECT_EQ(code_points("\xc3\xa9\xe2\x82\xac\xf0\x9d\x84\x9e"),
            (std::vector<char32_t>{0xE9, 0x20AC, 0x1D11E}));
  // A byte that begins nothing, an end in the middle, a byte that should go on, a control
  // character.
  EXPECT_EQ(code_points("\xff"), std::vector<char32_t>{0xFFFD});
  EXPECT_EQ(code_points("\xc3"), std::vector<char32_t>{0xFFFD});
  EXPECT_EQ(code_points("\xc3"
                        "a"),
            (std::vector<char32_t>{0xFFFD, U'a'}));
  EXPECT_EQ(code_points("\t"), std::vector<char32_t>{0xFFFD});
}

TEST(Font, HasTheLettersThatPicturesNeed) {
  const Font font;
  for (char32_t point = U' '; point <= U'~'; ++point) EXPECT_NE(font.glyph(point), 0);
  for (const char32_t point : {U'é', U'µ', U'×', U'Ω', U'я'}) EXPECT_NE(font.glyph(point), 0);
  EXPECT_EQ(font.glyph(0x10FFFF), 0);
  // Digits are equally wide, so that a time does not jump about.
  for (char32_t digit = U'1'; digit <= U'9'; ++digit) {
    EXPECT_EQ(font.advance(font.glyph(digit), 20.0f), font.advance(font.glyph(U'0'), 20.0f));
  }
}

TEST(Font, GrowsInProportion) {
  const Font font;
  const int glyph = font.glyph(U'm');
  EXPECT_NEAR(font.advance(glyph, 40.0f), 2.0f * font.advance(glyph, 20.0f), 1e-4f);
  EXPECT_NEAR(font.line_height(40.0f), 2.0f * font.line_height(20.0f), 1e-4f);
}

/// A glyph covers as much wherever in a pixel it begins; its centre moves by as much as the pen.
TEST(Font, PlacesGlyphsWithinPixels) {
  Font font;
  const int glyph = font.glyph(U'o');
  const auto centre_and_sum = [&](int place) {
    const GlyphBitmap& bitmap = font.bitmap(glyph, 24.0f, place);
    double sum = 0.0;
    double moment = 0.0;
    for (int y = 0; y < bitmap.height; ++y) {
      for (int x = 0; x < bitmap.width; ++x) {
        const double value = bitmap.coverage[static_cast<std::size_t>(y * bitmap.width + x)];
        sum += value;
        moment += value * (bitmap.left + x);
      }
    }
    return std::pair(moment / sum, sum);
  };
  const auto [first, sum] = centre_and_sum(0);
  for (int place = 1; place < Font::places; ++place) {
    const auto [centre, as_much] = centre_and_sum(place);
    EXPECT_NEAR(centre - first, static_cast<double>(place) / Font::places, 0.01);
    EXPECT_NEAR(as_much, sum, 0.005 * sum);  // bytes round
  }
}

TEST(Layout, KeepsEveryGlyphInItsWidth) {
  const Font font;
  const std::string text = "Soft torus, three soft spheres and four rigid cubes";
  const auto letters =
      static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return c != ' '; }));
  for (const float width : {400.0f, 200.0f, 90.0f}) {
    const TextLayout layout = lay_out(font, text, 14.0f, width);
    EXPECT_LE(layout.width, width);
    const int space = font.glyph(U' ');
    const auto placed = static_cast<std::size_t>(std::ranges::count_if(
        layout.glyphs, [&](const PlacedGlyph& glyph) { return glyph.glyph != space; }));
    EXPECT_EQ(placed, letters) << width;
  }
  // One line for each new line; where not even a glyph fits, one a line.
  EXPECT_NEAR(lay_out(font, "a\n\nb", 14.0f, 400.0f).height, 3.0f * font.line_height(14.0f), 1e-3f);
  EXPECT_NEAR(lay_out(font, "abc", 14.0f, 1.0f).height, 3.0f * font.line_height(14.0f), 1e-3f);
  EXPECT_TRUE(lay_out(font, "", 14.0f, 400.0f).glyphs.empty());
}

TEST(Layout, BreaksLinesAtSpaces) {
  const Font font;
  const float one_word = lay_out(font, "sphere", 14.0f, no_limit).width;
  const TextLayout layout = lay_out(font, "sphere sphere", 14.0f, 1.5f * one_word);
  EXPECT_EQ(layout.glyphs.size(), 12u) << "the space is gone";
  EXPECT_NEAR(layout.width, one_word, 1e-3f);
}

TEST(Layout, CoversNothingBeyondItsFrame) {
  Font font;
  const TextLayout tight = lay_out(font, "fjW", 30.0f, no_limit);
  const TextCoverage coverage = cover(font, tight);
  // The same within a wider frame.
  TextLayout wide = tight;
  wide.width += 40.0f;
  wide.height += 40.0f;
  for (PlacedGlyph& glyph : wide.glyphs) {
    glyph.x += 20.0f;
    glyph.baseline += 20.0f;
  }
  EXPECT_NEAR(covered(cover(font, wide)), covered(coverage), 1e-9);
}

TEST(RoundLength, IsOneTwoOrFive) {
  EXPECT_FLOAT_EQ(round_length(0.99f), 0.5f);
  EXPECT_FLOAT_EQ(round_length(1.01f), 1.0f);
  EXPECT_FLOAT_EQ(round_length(4.9f), 2.0f);
  EXPECT_FLOAT_EQ(round_length(73.0f), 50.0f);
  EXPECT_FLOAT_EQ(round_length(0.0021f), 0.002f);
}

/// The bar is as long as the metres that it names, where the camera's target is.
TEST(ScaleBar, IsAsLongAsItSays) {
  Frame frame = empty_frame();
  frame.camera = {{0, -10, 0}, {0, 0, 0}, 40.0f};
  RenderOptions options = small_picture();
  options.width = 640;
  options.height = 480;
  const Image empty = draw_once(frame, options);
  frame.scale_bar = true;
  const Image image = draw_once(frame, options);
  // A fifth of the picture's 9.7 m at that distance, rounded down: 1 m.
  const double metre = (seen_at(frame.camera, {0.5f, 0, 0}, 640, 480) -
                        seen_at(frame.camera, {-0.5f, 0, 0}, 640, 480))
                           .x();
  int longest = 0;
  for (int y = 240; y < 480; ++y) {
    int run = 0;
    for (int x = 320; x < 640; ++x) {
      run = pixel_at(image, x, y)[1] > 235 && pixel_at(empty, x, y)[1] < 235 ? run + 1 : 0;
      longest = std::max(longest, run);
    }
  }
  EXPECT_NEAR(longest, metre, 1.5);
}

TEST(Labels, StandOverTheirPointsWithinThePicture) {
  Frame frame = empty_frame();
  const Image empty = draw_once(frame, small_picture());
  frame.labels = {{{0, 0, 0}, "ball"}};
  const Image middle = draw_once(frame, small_picture());
  double sum = 0;
  double count = 0;
  for_each_difference(middle, empty, [&](int x, int y) {
    EXPECT_LT(y, 120);
    sum += x + 0.5;
    ++count;
  });
  ASSERT_GT(count, 50);
  EXPECT_NEAR(sum / count, 160.0, 1.0);
  // At the picture's corner it is moved, not cut.
  frame.labels[0].position = {-4.8f, 0, 3.6f};
  EXPECT_EQ(count_differences(draw_once(frame, small_picture()), empty), static_cast<int>(count));
  frame.labels[0].position = {0, -20, 0};
  EXPECT_EQ(count_differences(draw_once(frame, small_picture()), empty), 0) << "behind the eye";
}

TEST(Legends, ShowTheirColoursFromLowToHigh) {
  Frame frame = empty_frame();
  frame.legend = Legend{"speed", {{0, 0, 1}, {1, 0, 0}}, {{0.0f, "0"}, {1.0f, "5"}}};
  const Image image = draw_once(frame, small_picture());
  int blue = -1;
  int red = -1;
  for (int y = 0; y < 240; ++y) {
    for (int x = 160; x < 320; ++x) {
      const Pixel pixel = pixel_at(image, x, y);
      if (pixel == Pixel{0, 0, 255}) blue = y;
      if (pixel == Pixel{255, 0, 0} && red < 0) red = y;
    }
  }
  ASSERT_GE(red, 0);
  EXPECT_GT(blue, red) << "low is at the bottom";
}

}  // namespace
}  // namespace pneuma::render

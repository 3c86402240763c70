#include "app/picture/body_colours.h"

#include <gtest/gtest.h>

namespace pneuma::app {
namespace {

using render::Colour;
using sim::Vec3;

// To light and back in single precision.
constexpr float colour_rounding = 2e-6f;

void expect_colour(const Colour& actual, const Colour& expected,
                   float tolerance = colour_rounding) {
  EXPECT_LT((actual - expected).cwiseAbs().maxCoeff(), tolerance)
      << "is " << actual.transpose() << ", expected " << expected.transpose();
}

Colour from_bytes(int red, int green, int blue) {
  return Colour(static_cast<float>(red), static_cast<float>(green), static_cast<float>(blue)) /
         255.0f;
}

std::vector<Colour> colours_of(const std::vector<Vec3>& vertices,
                               const std::vector<std::string>& names,
                               const Vec3& axis = Vec3::UnitZ()) {
  return body_colours(vertices, names, axis);
}

const std::vector<Vec3> line = {{0.0, 0.0, -2.0}, {5.0, 5.0, 0.0}, {0.0, 0.0, 2.0}};

TEST(BodyColours, OneIsPlain) {
  for (const Colour& colour : colours_of(line, {"#d9381e"})) {
    expect_colour(colour, from_bytes(0xd9, 0x38, 0x1e));
  }
}

TEST(BodyColours, TwoRunAlongTheAxis) {
  const auto colours = colours_of(line, {"#FF0010", "#00ff20"});
  ASSERT_EQ(colours.size(), 3u);
  expect_colour(colours[0], from_bytes(255, 0, 16));
  expect_colour(colours[2], from_bytes(0, 255, 32));
}

TEST(BodyColours, MixAsLight) {
  // Half the light of white is 188 of 255 in sRGB (IEC 61966-2-1); a mean of the values is 128.
  const auto colours = colours_of(line, {"#000000", "#ffffff"});
  const float half_a_step = 0.5f / 255.0f;
  expect_colour(colours[1], from_bytes(188, 188, 188), half_a_step);
}

TEST(BodyColours, TakeTheAxisOfAnyLength) {
  const auto once = colours_of(line, {"#ff0000", "#0000ff"}, Vec3(0.1, 0.0, 1.0));
  const auto longer = colours_of(line, {"#ff0000", "#0000ff"}, Vec3(0.3, 0.0, 3.0));
  for (std::size_t i = 0; i < once.size(); ++i) expect_colour(once[i], longer[i]);
}

TEST(BodyColours, GiveABodyWithoutExtentTheFirstColour) {
  const std::vector<Vec3> flat = {{1.0, 0.0, 4.0}, {0.0, 1.0, 4.0}};
  for (const Colour& colour : colours_of(flat, {"#ff0000", "#0000ff"})) {
    expect_colour(colour, from_bytes(255, 0, 0));
  }
}

TEST(BodyColours, ThreeBelongToXYAndZ) {
  const std::vector<Vec3> corners = {
      {-1.0, -1.0, -1.0}, {1.0, -1.0, -1.0}, {-1.0, 1.0, -1.0}, {-1.0, -1.0, 1.0}, {1.0, 1.0, 1.0}};
  const auto colours = colours_of(corners, {"#ff0000", "#00ff00", "#0000ff"});
  expect_colour(colours[1], from_bytes(255, 0, 0));
  expect_colour(colours[2], from_bytes(0, 255, 0));
  expect_colour(colours[3], from_bytes(0, 0, 255));
  // All alike, where none and where all of the three directions lie: a grey.
  expect_colour(colours[0], colours[4]);
  EXPECT_NEAR(colours[0].x(), colours[0].y(), colour_rounding);
  EXPECT_NEAR(colours[0].y(), colours[0].z(), colour_rounding);
}

}  // namespace
}  // namespace pneuma::app

// Pictures against what optics and geometry say, without any stored picture.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "render/frame/camera.h"
#include "tests/render/probe.h"
#include "tests/render/shapes.h"

namespace pneuma::render {
namespace {

constexpr double radians = std::numbers::pi / 180.0;

TEST(Background, IsAVerticalGradientBrighterAtTheFoot) {
  const Image image = draw_once(empty_frame(), small_picture());
  for (int y = 0; y < image.height; ++y) {
    const Pixel left = pixel_at(image, 0, y);
    for (int x = 1; x < image.width; ++x) ASSERT_EQ(pixel_at(image, x, y), left);
    if (y == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) EXPECT_GE(left[c], pixel_at(image, 0, y - 1)[c]);
  }
  EXPECT_GT(pixel_at(image, 0, 239)[0], pixel_at(image, 0, 0)[0] + 20);
}

TEST(Background, IsUntouchedByMeshesOutOfView) {
  Frame frame = empty_frame();
  const Image empty = draw_once(frame, small_picture());
  frame.meshes = {make_ball({0, -20, 0}, 3.0f, {1, 0, 0}), make_ball({30, 0, 0}, 3.0f, {0, 1, 0}),
                  make_box({0, 0, -20}, {2, 2, 2}, {0, 0, 1})};
  EXPECT_EQ(draw_once(frame, small_picture()).pixels, empty.pixels);
}

TEST(Silhouette, OfABallHasTheAreaOfItsProjection) {
  Frame frame = empty_frame();
  const Image empty = draw_once(frame, small_picture(1));
  frame.meshes = {make_ball({0, 0, 0}, 2.0f, {0.1f, 0.1f, 0.1f}, 64)};
  const Image image = draw_once(frame, small_picture(1));

  double count = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for_each_difference(image, empty, [&](int x, int y) {
    ++count;
    sum += Eigen::Vector2d(x + 0.5, y + 0.5);
  });
  // A ball of radius r at distance d fills a cone of half angle asin(r / d). Its outline fades over
  // the next pixel; of that, less than a hundredth is too faint to be seen.
  const double radius = std::tan(std::asin(2.0 / 10.0)) / std::tan(20.0 * radians) * 120.0 + 0.995;
  const double area = std::numbers::pi * radius * radius;
  // 128 flat sides lack 0.04 %; a circle of 67 pixels' radius holds its area in pixels to about 30.
  EXPECT_NEAR(count, area, 0.0004 * area + 30.0);
  EXPECT_NEAR(sum.x() / count, 160.0, 0.1);
  EXPECT_NEAR(sum.y() / count, 120.0, 0.1);
}

TEST(Samples, GiveQuartersAtEdges) {
  // A dark face with slanting edges, seen from the front and from so far away that it mirrors the
  // same all over.
  Frame frame = empty_frame();
  frame.light.direction = {0, -1, 0};
  frame.camera.eye *= 10.0f;
  frame.camera.field_of_view = 4.17f;
  const Image empty = draw_once(frame, small_picture());
  frame.meshes = {make_box({0, 0, 0}, {3, 0.1f, 3}, {0, 0, 0})};
  for (Vec3f& position : frame.meshes[0].positions) {
    position = Eigen::AngleAxisf(0.1f, Vec3f::UnitY()) * position;
  }
  const auto shares = [&](int samples) {
    const Image image = draw_once(frame, small_picture(samples));
    const double dark = pixel_at(image, 160, 120)[0];
    std::array<int, 5> count = {};
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 320; ++x) {
        const double ground = pixel_at(empty, x, y)[0];
        const double quarters = 4.0 * (ground - pixel_at(image, x, y)[0]) / (ground - dark);
        // A byte of the ground's, and one of the face's, of about 150 between them.
        EXPECT_NEAR(quarters, std::round(quarters), 0.06);
        ++count[static_cast<std::size_t>(std::lround(quarters))];
      }
    }
    return count;
  };
  const auto two = shares(2);
  EXPECT_EQ(two[1] + two[3], 0);
  const auto four = shares(4);
  for (const std::size_t quarters : {1u, 2u, 3u}) EXPECT_GT(four[quarters], 20) << quarters;
}

Frame busy_frame() {
  Frame frame;
  frame.camera.eye = {3, -9, 5};
  frame.meshes = {make_ball({0, 0, 1}, 1.0f, {0.9f, 0.2f, 0.1f}),
                  make_box({2, 0, 0.5f}, {1, 1, 1}, {0.2f, 0.4f, 0.9f})};
  frame.points = {{{0, 0, 2.2f}, {1, 1, 0}}, {{0.1f, 0, 2.2f}, {0, 1, 1}}};
  frame.lines = {{{0, 0, 0}, {0, 0, 4}, {1, 0, 1}}};
  frame.caption = Caption{"busy"};
  return frame;
}

/// By the samples a pixel.
class RendererOf : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Samples, RendererOf, testing::Values(1, 4));

TEST_P(RendererOf, DrawsTheSameBytesWhateverWasDrawnBefore) {
  const Image alone = draw_once(busy_frame(), small_picture(GetParam()));
  Renderer renderer(small_picture(GetParam()));
  Image image;
  renderer.draw(busy_frame(), image);
  EXPECT_EQ(image.pixels, alone.pixels);
  renderer.draw(busy_frame(), image);
  EXPECT_EQ(image.pixels, alone.pixels) << "the second time";

  Frame other = busy_frame();
  other.light = {{1, 0, -1}, 0.1f, true};
  other.wireframe = true;
  other.ground->grid_spacing = 0.3f;
  Frame bare = empty_frame();
  bare.lines = busy_frame().lines;
  Frame dark = busy_frame();
  dark.light.shadows = false;
  for (const Frame& before : {other, bare, dark, Frame{}}) {
    renderer.draw(before, image);
    EXPECT_NE(image.pixels, alone.pixels);
    renderer.draw(busy_frame(), image);
    EXPECT_EQ(image.pixels, alone.pixels);
  }
}

TEST_P(RendererOf, LeavesNothingOfThePictureBefore) {
  // No pass clears the picture: the background must cover every pixel, and the layer of bodies must
  // be empty, wherever the camera stands. What they missed would show red or blue, as the picture
  // before was.
  Frame red = empty_frame();
  red.meshes = {make_box({0, 0, 0}, {50, 1, 50}, {1, 0, 0})};
  Frame blue = empty_frame();
  blue.meshes = {make_box({0, 0, 0}, {50, 1, 50}, {0, 0, 1})};
  Renderer renderer(small_picture(GetParam()));
  Image after_red;
  Image after_blue;
  std::mt19937 random(7);
  const auto in = [&random](float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  };
  for (int i = 0; i < 60; ++i) {
    Frame frame;
    const float height = i % 3 == 0 ? 0.01f : 8.0f;
    frame.camera = {
        {in(-5, 5), in(-9, 9), in(0, height)}, {in(-2, 2), in(-2, 2), in(-3, 4)}, in(2, 120)};
    frame.light.shadows = i % 2 == 0;
    frame.meshes = {make_ball({in(-9, 9), in(-9, 9), in(-1, 5)}, in(0.1f, 3), {0, 1, 0}, 8)};
    renderer.draw(red, after_red);
    renderer.draw(frame, after_red);
    renderer.draw(blue, after_blue);
    renderer.draw(frame, after_blue);
    EXPECT_EQ(count_differences(after_red, after_blue), 0)
        << "eye " << frame.camera.eye.transpose() << " target " << frame.camera.target.transpose()
        << " field of view " << frame.camera.field_of_view;
  }
}

TEST(Ground, IsAtHeightZeroAndUnseenFromBelow) {
  Frame frame = empty_frame();
  frame.camera = {{0, -10, -3}, Vec3f::Zero(), 40.0f};
  const Image empty = draw_once(frame, small_picture());
  frame.ground = Ground{};
  EXPECT_EQ(draw_once(frame, small_picture()).pixels, empty.pixels);

  // A ball half sunk: what lies below z = 0 is hidden.
  frame.camera.eye = {0, -10, 3};
  const Image ground = draw_once(frame, small_picture(1));
  frame.meshes = {make_ball({0, 0, 0}, 1.0f, {0.1f, 0.1f, 0.1f})};
  const Image ball = draw_once(frame, small_picture(1));
  int lowest = 0;
  for_each_difference(ball, ground, [&](int, int y) { lowest = std::max(lowest, y); });
  const double waterline = seen_at(frame.camera, {0, -1, 0}, 320, 240).y();
  EXPECT_NEAR(lowest + 0.5, waterline, 1.0) << "one pixel";
}

TEST(Ground, HasALineAtEachSpacing) {
  Frame frame = empty_frame();
  frame.camera = {{0.5f, 0, 10}, {0.5f, 0, 0}, 40.0f};
  frame.ground = Ground{1.0f};
  RenderOptions options = small_picture();
  options.width = 640;
  options.height = 480;
  const Image image = draw_once(frame, options);
  const auto at = [&](float x) { return pixel_of(image, frame.camera, {x, 0.5f, 0})[1]; };
  for (const float line : {-2.0f, -1.0f, 1.0f, 2.0f}) {
    // A pixel is 15 mm here: the line is within one to either side.
    const int darkest = std::min({at(line - 0.015f), at(line), at(line + 0.015f)});
    EXPECT_LT(darkest, at(line + 0.5f) - 4) << line;
    EXPECT_LE(std::abs(at(line + 0.3f) - at(line + 0.5f)), 1) << "no lines between";
  }
  const int fifth = std::min({at(-0.015f), at(0.0f), at(0.015f)});
  EXPECT_LT(fifth, std::min({at(0.985f), at(1.0f), at(1.015f)}) - 5) << "every fifth is stronger";
}

TEST(Ground, FadesIntoTheBackground) {
  Frame frame = empty_frame();
  frame.camera = {{0, -5, 1}, {0, 0, 1}, 60.0f};
  const Image empty = draw_once(frame, small_picture());
  frame.ground = Ground{};
  const Image image = draw_once(frame, small_picture());
  // Just above the horizon there is no ground, and just below it, nothing to tell from that.
  for (int x = 0; x < 320; x += 7) {
    EXPECT_EQ(pixel_at(image, x, 110), pixel_at(empty, x, 110));
    EXPECT_LE(greatest_difference(pixel_at(image, x, 124), pixel_at(empty, x, 124)), 2);
  }
  EXPECT_GT(count_differences(image, empty), 320 * 60) << "but there is a ground";
}

}  // namespace
}  // namespace pneuma::render

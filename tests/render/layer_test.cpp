// The bodies are drawn in a part of the picture only, and without the ground: nothing shows of it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/render/probe.h"
#include "tests/render/shapes.h"

namespace pneuma::render {
namespace {

/// By the samples a pixel: with one, bodies are drawn on the picture itself.
class LayerOf : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Samples, LayerOf, testing::Values(1, 4));

TEST_P(LayerOf, HoldsAllOfTheBodiesWhereverTheyAreSeen) {
  Renderer renderer(small_picture(GetParam()));
  Image part;
  Image whole;
  std::mt19937 random(11);
  const auto in = [&random](float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  };
  for (int i = 0; i < 60; ++i) {
    const Vec3f place = {in(-3, 3), in(-3, 3), in(1.5f, 4)};
    Frame frame;
    frame.camera = {{in(-9, 9), in(-14, -5), in(0.1f, 6)}, Vec3f::Zero(), in(20, 110)};
    frame.light.shadows = i % 2 == 0;
    frame.meshes = {make_ball(place, in(0.3f, 1.4f), {0.9f, 0.3f, 0.1f}, 12)};
    renderer.draw(frame, part);
    // A frame with points is drawn on all of the picture. This one, inside the ball, is not seen.
    frame.points = {{place, {0, 1, 0}, 0.01f, false}};
    renderer.draw(frame, whole);
    EXPECT_EQ(count_differences(part, whole), 0)
        << "eye " << frame.camera.eye.transpose() << " ball " << place.transpose()
        << " field of view " << frame.camera.field_of_view;
  }
}

TEST_P(LayerOf, HoldsBodiesThatReachBehindTheEye) {
  // A wall beside the eye, from 5 m behind it to 10 m before it: to the right of where its far end
  // is seen, it fills the picture.
  Frame frame = empty_frame();
  frame.meshes = {make_box({1.1f, -7.5f, 0}, {0.2f, 15, 40}, {1, 0, 0})};
  const Image empty = draw_once(empty_frame(), small_picture(GetParam()));
  const Image image = draw_once(frame, small_picture(GetParam()));
  const double tangent = std::tan(20.0 * std::numbers::pi / 180.0) * 320.0 / 240.0;
  const int edge = static_cast<int>(160.0 * (1.0 + 1.0 / 10.0 / tangent));
  for (int y = 0; y < image.height; ++y) {
    EXPECT_EQ(pixel_at(image, edge - 2, y), pixel_at(empty, edge - 2, y));
    for (int x = edge + 2; x < image.width; ++x) {
      EXPECT_NE(pixel_at(image, x, y), pixel_at(empty, x, y)) << x << ' ' << y;
    }
  }
}

TEST_P(LayerOf, IsHiddenBelowTheGround) {
  Frame frame;
  frame.camera = {{0, -12, 5}, Vec3f::Zero(), 40.0f};
  frame.light.shadows = false;
  const Image ground = draw_once(frame, small_picture(GetParam()));
  frame.meshes = {make_box({0, 0, 0}, {2, 2, 2}, {0.8f, 0.1f, 0.1f})};
  for (const bool with_wireframe : {false, true}) {
    frame.wireframe = with_wireframe;
    const Image image = draw_once(frame, small_picture(GetParam()));
    for (const float z : {-0.2f, -0.5f, -0.9f}) {
      const Vec3f below = {0.3f, -1, z};
      EXPECT_EQ(pixel_of(image, frame.camera, below), pixel_of(ground, frame.camera, below)) << z;
    }
    const Vec3f above = {0.3f, -1, 0.3f};
    EXPECT_NE(pixel_of(image, frame.camera, above), pixel_of(ground, frame.camera, above));
  }
}

TEST(Ground, IsDrawnAnewWhenAnythingInItChanges) {
  Renderer renderer(small_picture());
  Frame frame;
  frame.camera = {{0, -12, 5}, Vec3f::Zero(), 40.0f};
  Image image;
  renderer.draw(frame, image);
  const auto expect_as_new = [&](const char* what) {
    renderer.draw(frame, image);
    EXPECT_EQ(count_differences(image, draw_once(frame, small_picture())), 0) << what;
  };
  frame.camera.eye.x() += 0.5f;
  expect_as_new("eye");
  frame.camera.target.y() += 0.5f;
  expect_as_new("target");
  frame.camera.field_of_view = 50.0f;
  expect_as_new("field of view");
  frame.ground->grid_spacing = 0.7f;
  expect_as_new("grid");
  frame.meshes = {
      make_ball({80, 0, 3}, 3.0f, {1, 0, 0}, 8)};  // reaches further than the ground did
  expect_as_new("radius");
  frame.ground.reset();
  expect_as_new("no ground");
}

}  // namespace
}  // namespace pneuma::render

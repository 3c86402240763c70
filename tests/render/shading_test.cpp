// Colours of surfaces against Phong's formula, worked out in double precision.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/render/probe.h"
#include "tests/render/shapes.h"

namespace pneuma::render {
namespace {

constexpr double radians = std::numbers::pi / 180.0;

/// The renderer's light, restated from passes/look.h.
const Eigen::Array3d sun = {0.80, 0.775, 0.73};
const Eigen::Array3d sky = {0.34, 0.37, 0.42};
const Eigen::Array3d bounce = {0.16, 0.15, 0.14};

double srgb_to_linear(double c) {
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

double linear_to_srgb(double c) {
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}

/// What a flat surface shows: the hemisphere's light and the sun's on the colour, the mirrored sky
/// where it is seen at a slant, and the highlight.
Pixel shaded(const Colour& colour, const Eigen::Vector3d& normal, const Eigen::Vector3d& to_light,
             const Eigen::Vector3d& to_eye) {
  const Eigen::Array3d albedo =
      colour.cast<double>().array().unaryExpr([](double c) { return srgb_to_linear(c); });
  const double up = 0.5 + 0.5 * normal.z();
  const double lit = std::max(0.0, normal.dot(to_light));
  const Eigen::Vector3d mirrored = 2.0 * normal.dot(to_light) * normal - to_light;
  const double shine =
      std::pow(std::max(0.0, mirrored.dot(to_eye)), 64.0) * std::min(1.0, 4.0 * lit);
  const double grazing = std::pow(1.0 - std::max(0.0, normal.dot(to_eye)), 3.0);
  const Eigen::Array3d light = albedo * (bounce + up * (sky - bounce) + sun * lit) +
                               0.6 * shine * sun + 0.25 * grazing * sky;
  Pixel pixel;
  for (int c = 0; c < 3; ++c) {
    pixel[static_cast<std::size_t>(c)] =
        static_cast<int>(std::lround(255.0 * std::min(1.0, linear_to_srgb(light[c]))));
  }
  return pixel;
}

struct PlaneCase {
  const char* name;
  Vec3f eye;
  Vec3f light;
};

class LitPlane : public testing::TestWithParam<PlaneCase> {};

TEST_P(LitPlane, HasTheColourThatPhongGives) {
  const PlaneCase& plane = GetParam();
  const Colour colour = {0.7f, 0.4f, 0.1f};
  Frame frame = empty_frame();
  frame.meshes = {make_box({0, 0, -0.5f}, {4, 4, 1}, colour)};
  frame.camera.eye = plane.eye;
  frame.light.direction = plane.light;
  const Image image = draw_once(frame, small_picture());
  const Pixel expected =
      shaded(colour, Eigen::Vector3d::UnitZ(), -plane.light.cast<double>().normalized(),
             plane.eye.cast<double>().normalized());
  // One for rounding, one for llvmpipe's pow, which is good to about 1e-3.
  EXPECT_LE(greatest_difference(pixel_of(image, frame.camera, Vec3f::Zero()), expected), 2);
}

INSTANTIATE_TEST_SUITE_P(Each, LitPlane,
                         testing::Values(PlaneCase{"head_on", {0, -8.66f, 5}, {0, 0, -1}},
                                         PlaneCase{"slanting", {0, -6, 8}, {1, 0.5f, -1}},
                                         PlaneCase{"from_behind", {3, -6, 8}, {0, 0, 1}},
                                         PlaneCase{"in_the_highlight", {0, -5, 5}, {0, -1, -1}},
                                         PlaneCase{"grazing_view", {0, -10, 1}, {0.3f, 0, -1}}),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(SmoothShading, HasTheColourThatPhongGivesABall) {
  const Colour colour = {0.7f, 0.4f, 0.1f};
  Frame frame = empty_frame();
  frame.light.direction = {-0.5f, 1, -1};
  frame.meshes = {make_ball({0, 0, 0}, 2.0f, colour, 48)};
  const Image image = draw_once(frame, small_picture());
  const Vec3f to_light = -frame.light.direction.normalized();
  for (float x = -0.7f; x <= 0.71f; x += 0.1f) {
    for (float z = -0.7f; z <= 0.71f; z += 0.1f) {
      const float forward = 1.0f - x * x - z * z;
      if (forward < 0.25f) continue;  // not too near the outline, where a pixel spans much
      // The ball at the middle of a pixel: where that pixel's ray meets it.
      const Eigen::Vector2d seen =
          seen_at(frame.camera, 2.0f * Vec3f(x, -std::sqrt(forward), z), 320, 240);
      const double slope = std::tan(20.0 * radians) / 120.0;
      const Eigen::Vector3d ray = Eigen::Vector3d((std::floor(seen.x()) + 0.5 - 160.0) * slope, 1.0,
                                                  (120.0 - std::floor(seen.y()) - 0.5) * slope)
                                      .normalized();
      const Eigen::Vector3d eye = frame.camera.eye.cast<double>();
      const double along = -eye.dot(ray);
      const double depth = along - std::sqrt(along * along - eye.squaredNorm() + 4.0);
      const Eigen::Vector3d normal = (eye + depth * ray) / 2.0;
      const Pixel expected = shaded(colour, normal, to_light.cast<double>(), -ray);
      // Rounding and pow as above; 48 rings of flat faces lie up to 2 mm below the ball.
      EXPECT_LE(
          greatest_difference(
              pixel_at(image, static_cast<int>(seen.x()), static_cast<int>(seen.y())), expected),
          3)
          << "normal " << normal.transpose();
    }
  }
}

TEST(SmoothShading, HasNoFacets) {
  // Light from the side: the brightness across a coarse ball changes in small steps, as the
  // interpolated normals do, while the same ball without normals shows its faces.
  Frame frame = empty_frame();
  frame.light.direction = {-1, 0.5f, 0};
  frame.meshes = {make_ball({0, 0, 0}, 2.5f, {0.8f, 0.8f, 0.8f}, 10)};
  const auto greatest_step = [&frame] {
    const Image image = draw_once(frame, small_picture());
    int greatest = 0;
    for (int x = 120; x < 200; ++x) {
      greatest = std::max(
          greatest, greatest_difference(pixel_at(image, x, 120), pixel_at(image, x + 1, 120)));
    }
    return greatest;
  };
  const int smooth = greatest_step();
  frame.meshes[0].normals.clear();
  const int flat = greatest_step();
  // From terminator to brightest, 0 to 200 over 67 pixels, steepest at the terminator.
  EXPECT_LE(smooth, 8);
  EXPECT_GE(flat, 3 * smooth);
}

TEST(VertexColours, AreMixedInLinearLight) {
  // Halfway between black and white is linear 0.5, sRGB 188, not 128. A flat face lit from the
  // front, its left corners black and its right ones white.
  Frame frame = empty_frame();
  frame.light.direction = {0, 1, 0};
  Mesh box = make_box({0, 0, 0}, {4, 1, 3}, {1, 1, 1});
  auto shape = std::make_shared<MeshShape>(*box.shape);
  for (const std::size_t left : {0u, 2u, 4u, 6u}) shape->colours[left].setZero();
  box.shape = shape;
  frame.meshes = {box};
  // The eye stands aside, out of the highlight.
  frame.camera.eye = {6, -9, 0};
  const Image image = draw_once(frame, small_picture());
  const auto half = static_cast<float>(linear_to_srgb(0.5));
  const Vec3f middle = {0, -0.5f, 0};
  const Pixel expected =
      shaded({half, half, half}, -Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitY(),
             (frame.camera.eye - middle).cast<double>().normalized());
  // Half a pixel is a hundredth of the way from black to white here.
  EXPECT_LE(greatest_difference(pixel_of(image, frame.camera, middle), expected), 4);
}

}  // namespace
}  // namespace pneuma::render

// Colours of surfaces against the formulas of their papers, worked out in double precision.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/render/probe.h"
#include "tests/render/shapes.h"

namespace pneuma::render {
namespace {

constexpr double roughness = 0.35;  // of meshes that say nothing else

/// The renderer's light, restated from light/environment.h.
const Eigen::Array3d sun = {0.95, 0.90, 0.80};
const Eigen::Array3d zenith = {0.36, 0.42, 0.53};
const Eigen::Array3d horizon = {0.58, 0.60, 0.63};
const Eigen::Array3d floor_light = {0.60, 0.60, 0.58};

Eigen::Array3d sky_at(double z) {
  return z <= 0.0 ? Eigen::Array3d(0.0, 0.0, 0.0)
                  : Eigen::Array3d(horizon + (zenith - horizon) * z * (2.0 - z));
}

/// Of the sky on a tilted surface, over pi, by quadrature over all directions.
Eigen::Array3d irradiance(const Eigen::Vector3d& normal) {
  constexpr int rings = 100;
  constexpr int around = 200;
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int i = 0; i < rings; ++i) {
    const double z = (i + 0.5) / rings;
    for (int j = 0; j < around; ++j) {
      const double angle = 2.0 * std::numbers::pi * (j + 0.5) / around;
      const double across = std::sqrt(1.0 - z * z);
      const Eigen::Vector3d d(across * std::cos(angle), across * std::sin(angle), z);
      sum += std::max(0.0, d.dot(normal)) * sky_at(z);
    }
  }
  return sum * (2.0 / (rings * around));
}

/// Khronos PBR Neutral, as its specification writes it, but that the luminance which its offset
/// takes is given back.
Eigen::Array3d tone_mapped(Eigen::Array3d light) {
  const double least = light.minCoeff();
  const Eigen::Array3d luminance = {0.2126, 0.7152, 0.0722};
  const double before = (light * luminance).sum();
  light -= least < 0.08 ? least - 6.25 * least * least : 0.04;
  light *= before / (light * luminance).sum();
  const double peak = light.maxCoeff();
  if (peak < 0.76) return light;
  const double d = 1.0 - 0.76;
  const double new_peak = 1.0 - d * d / (peak + d - 0.76);
  light *= new_peak / peak;
  const double g = 1.0 - 1.0 / (0.15 * (peak - new_peak) + 1.0);
  return light * (1.0 - g) + new_peak * g;
}

double srgb_to_linear(double c) {
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

double linear_to_srgb(double c) {
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}

double schlick(double cosine, double grazing) {
  return 0.04 + (grazing - 0.04) * std::pow(1.0 - cosine, 5.0);
}

/// Pi D V F of GGX.
double highlight(const Eigen::Vector3d& n, const Eigen::Vector3d& l, const Eigen::Vector3d& v) {
  const Eigen::Vector3d h = (l + v).normalized();
  const double a = roughness * roughness;
  const double nl = std::max(0.0, n.dot(l));
  const double nv = n.dot(v);
  const double t = std::pow(std::max(0.0, n.dot(h)), 2.0) * (a * a - 1.0) + 1.0;
  const double visibility = 0.5 / std::max(1e-3, (1.0 - a) * 2.0 * nl * nv + a * (nl + nv));
  return a * a / (t * t) * visibility * schlick(std::max(0.0, v.dot(h)), 1.0);
}

/// What a surface shows alone under the sky: the light on its colour but for what it mirrors.
Pixel shaded(const Colour& colour, const Eigen::Vector3d& normal, const Eigen::Vector3d& to_light,
             const Eigen::Vector3d& to_eye) {
  const Eigen::Array3d albedo =
      colour.cast<double>().array().unaryExpr([](double c) { return srgb_to_linear(c); });
  const double lit = std::max(0.0, normal.dot(to_light));
  const Eigen::Array3d diffuse =
      sun * lit + irradiance(normal) + floor_light * (0.5 - 0.5 * normal.z());
  const Eigen::Vector3d mirror = 2.0 * normal.dot(to_eye) * normal - to_eye;
  const double t = std::clamp((mirror.z() + roughness) / (2.0 * roughness), 0.0, 1.0);
  const double above = t * t * (3.0 - 2.0 * t);
  const Eigen::Array3d mirrored =
      floor_light * (1.0 - above) + (mirror.z() > 0.0 ? sky_at(mirror.z()) : horizon) * above;
  const double smoothness = 1.0 - roughness;
  const double reflected = std::min(schlick(normal.dot(to_eye), smoothness),
                                    smoothness * smoothness * (0.5 + 0.5 * smoothness));
  const Eigen::Array3d light =
      tone_mapped(0.96 * albedo * diffuse * (1.0 - reflected) + mirrored * reflected +
                  sun * lit * highlight(normal, to_light, to_eye));
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

TEST_P(LitPlane, HasTheColourThatTheFormulasGive) {
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
  // One for rounding, one for the root in place of powers, one for the harmonics in place of the
  // sky.
  EXPECT_LE(greatest_difference(pixel_of(image, frame.camera, Vec3f::Zero()), expected), 3);
}

INSTANTIATE_TEST_SUITE_P(Each, LitPlane,
                         testing::Values(PlaneCase{"head_on", {0, -8.66f, 5}, {0, 0, -1}},
                                         PlaneCase{"slanting", {0, -6, 8}, {1, 0.5f, -1}},
                                         PlaneCase{"from_behind", {3, -6, 8}, {0, 0, 1}},
                                         PlaneCase{"in_the_highlight", {0, -5, 5}, {0, -1, -1}},
                                         PlaneCase{"grazing_view", {0, -10, 1}, {0.3f, 0, -1}}),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(SmoothShading, HasTheColourThatTheFormulasGiveABall) {
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
      const double slope = std::tan(std::numbers::pi / 9.0) / 120.0;
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

// Outlines: where a surface ends, found and drawn.
#include "render/geometry/outline.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "tests/render/probe.h"
#include "tests/render/shapes.h"

namespace pneuma::render {
namespace {

using Ends = std::pair<std::array<float, 3>, std::array<float, 3>>;

Ends ends_of(const Vec3f& from, const Vec3f& to) {
  return {{from.x(), from.y(), from.z()}, {to.x(), to.y(), to.z()}};
}

/// By a map of all edges: those that have one triangle which faces the eye, in its direction. Of a
/// flat mesh also those of two that lie at an angle, in either.
void expect_outline(const Mesh& mesh, const Vec3f& eye) {
  Frame frame = empty_frame();
  frame.camera.eye = eye;
  frame.meshes = {mesh};
  DrawnSurface surface;
  const View view = make_view(frame, 320, 240);
  surface.build(frame, view);
  Outline outline;
  outline.find(surface, view);

  std::map<Ends, std::vector<Vec3f>> sides;  // the normals of what faces the eye, by direction
  for (const Triangle& t : surface.triangles()) {
    const auto at = [&](std::size_t i) { return surface.vertices()[t[i % 3]].position; };
    const Vec3f normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    if (normal.dot(eye - at(0)) <= 0.0f) continue;
    for (std::size_t i = 0; i < 3; ++i) sides[ends_of(at(i), at(i + 1))].push_back(normal);
  }
  std::set<Ends> expected, creases;
  for (const auto& [ends, normals] : sides) {
    const auto other = sides.find({ends.second, ends.first});
    if (other == sides.end()) {
      expected.insert(ends);
    } else if (mesh.normals.empty() && normals[0].dot(other->second[0]) < 0.98f) {
      creases.insert(ends);
    }
  }
  std::set<Ends> found;
  for (const OutlineEdge& edge : outline.edges()) {
    const Ends ends =
        ends_of(surface.vertices()[edge.from].position, surface.vertices()[edge.to].position);
    EXPECT_TRUE(found.insert(ends).second) << "twice";
    EXPECT_TRUE(expected.contains(ends) || creases.contains(ends));
  }
  for (const Ends& ends : expected) EXPECT_TRUE(found.contains(ends));
  for (const Ends& ends : creases) {
    EXPECT_NE(found.contains(ends), found.contains({ends.second, ends.first})) << "on one side";
  }
  EXPECT_GT(expected.size(), 3u);
}

TEST(Outline, IsWhereOneTriangleOfTwoFacesTheEye) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> coordinate(-8.0f, 8.0f);
  for (int i = 0; i < 30; ++i) {
    Vec3f eye = {coordinate(random), coordinate(random), coordinate(random)};
    while (eye.norm() < 4.0f) eye *= 1.5f;
    expect_outline(make_ring({0, 0, 0}, 2.0f, 0.5f, {1, 0, 0}, {0, 1, 0}), eye);
    expect_outline(make_box({0, 0, 0}, {2, 1, 3}, {1, 0, 0}), eye);
  }
}

TEST(Outlines, CoverAPixelByItsDistanceFromTheEdge) {
  // A dark face seen from the front and from so far away that it mirrors the same all over.
  constexpr double distance = 100.0, half = 1.5, angle = 0.1;
  Frame frame = empty_frame();
  frame.light.direction = {0, -1, 0};
  frame.camera.eye = {0, -static_cast<float>(distance), 0};
  frame.camera.field_of_view = 4.17f;
  const Image empty = draw_once(frame, small_picture());
  frame.meshes = {make_box({0, 0, 0}, {2 * half, 0.1f, 2 * half}, {0, 0, 0})};
  for (Vec3f& position : frame.meshes[0].positions) {
    position = Eigen::AngleAxisf(static_cast<float>(angle), Vec3f::UnitY()) * position;
  }
  const Image image = draw_once(frame, small_picture());
  const double dark = pixel_at(image, 160, 120)[0];
  const double pixels_per_metre =
      120.0 / std::tan(0.5 * 4.17 * std::numbers::pi / 180.0) / (distance - 0.05);
  int between = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      // In the face's own axes, in pixels from its middle.
      const Eigen::Vector2d at =
          Eigen::Rotation2Dd(angle) * Eigen::Vector2d(x + 0.5 - 160.0, 120.0 - (y + 0.5));
      const Eigen::Array2d beyond = at.array().abs() - half * pixels_per_metre;
      if (beyond.minCoeff() > -2.0) continue;  // at a corner
      const double covered = std::clamp(1.0 - beyond.maxCoeff(), 0.0, 1.0);
      const double ground = pixel_at(empty, x, y)[0];
      // A byte of the ground's, and one of the face's, of about 150 between them.
      EXPECT_NEAR((ground - pixel_at(image, x, y)[0]) / (ground - dark), covered, 0.02)
          << x << ' ' << y;
      between += covered > 0.1 && covered < 0.9 ? 1 : 0;
    }
  }
  EXPECT_GT(between, 100);
}

TEST(Outlines, OfWhatReachesBehindTheEyeAreNotDrawnAcrossThePicture) {
  Frame frame = empty_frame();
  // A floor of which the nearest corners lie behind the eye.
  frame.meshes = {make_box({0, -9, -1.5f}, {4, 12, 1}, {1, 0, 0})};
  const Image image = draw_once(frame, small_picture());
  const Image empty = draw_once(empty_frame(), small_picture());
  for (int y = 0; y < 118; ++y) {
    for (int x = 0; x < image.width; ++x) {
      ASSERT_EQ(pixel_at(image, x, y), pixel_at(empty, x, y)) << x << ' ' << y;
    }
  }
}

}  // namespace
}  // namespace pneuma::render

// How near bodies come to the ground, as a picture from above.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/light/contact_shade.h"
#include "tests/render/shapes.h"

namespace pneuma::render {
namespace {

/// Ten texels to a metre, the origin in the middle.
GroundPicture ten_to_a_metre(float reach) {
  Mat4f to_picture = Mat4f::Identity();
  to_picture(0, 0) = to_picture(1, 1) = 10.0f / 64.0f;
  to_picture(0, 3) = to_picture(1, 3) = 0.5f;
  return {to_picture, 64, reach};
}

/// Empty: none. Normals and colours have no part in it.
std::vector<float> nearness_of(const Mesh& mesh, float reach) {
  std::vector<SurfaceVertex> vertices;
  for (const Vec3f& position : mesh.positions)
    vertices.push_back({position, Vec3f::Zero(), 1.0f, Eigen::Vector4f::Zero()});
  std::vector<float> nearness;
  const auto& triangles = mesh.shape->triangles;
  const bool any = measure_nearness(vertices, triangles, ten_to_a_metre(reach), nearness);
  return any ? nearness : std::vector<float>();
}

TEST(Nearness, IsThatOfABallsUnderside) {
  const float radius = 2.0f;
  const float reach = 0.8f;
  const Mesh ball = make_ball({0, 0, radius}, radius, {1, 1, 1}, 96);
  const std::vector<float> nearness = nearness_of(ball, reach);
  ASSERT_FALSE(nearness.empty());
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 64; ++column) {
      const float away =
          std::hypot(static_cast<float>(column) - 31.5f, static_cast<float>(row) - 31.5f) / 10.0f;
      const float height =
          away < radius ? radius - std::sqrt(radius * radius - away * away) : radius;
      const float left = std::max(0.0f, 1.0f - height / reach);
      // A vertex counts for all of its texel, half a diagonal of which changes the height by up to
      // 0.08 m at the reach's end.
      EXPECT_NEAR(nearness[static_cast<std::size_t>(row * 64 + column)], left * left, 0.16)
          << column << ' ' << row;
    }
  }
}

TEST(Nearness, IsNoneOfWhatFloats) {
  const Mesh box = make_box({0, 0, 2}, {2, 2, 2}, {1, 1, 1});
  EXPECT_TRUE(nearness_of(box, 0.8f).empty());
  EXPECT_FALSE(nearness_of(box, 1.5f).empty());
}

TEST(Nearness, OfWhatIsSunkIsWhereItGoesThroughTheGround) {
  const Mesh box = make_box({0, 0, 0}, {2, 2, 2}, {1, 1, 1});
  const std::vector<float> nearness = nearness_of(box, 0.8f);
  ASSERT_FALSE(nearness.empty());
  const auto at = [&](int column) { return nearness[static_cast<std::size_t>(32 * 64 + column)]; };
  EXPECT_EQ(at(32), 0.0f);  // a metre above the sunk side
  EXPECT_EQ(std::max(at(41), at(42)), 1.0f);
}

}  // namespace
}  // namespace pneuma::render

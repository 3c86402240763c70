#include "app/picture/rounding_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/geometry/rounding.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"

namespace pneuma::app {
namespace {

using render::Vec3f;

render::Mesh ball(const Vec3f& centre) {
  const sim::TriangleMesh mesh = sim::make_sphere(1.0, 8, 8);
  auto shape = std::make_shared<render::MeshShape>();
  render::Mesh result;
  for (const auto& t : mesh.triangles) {
    shape->triangles.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                                static_cast<std::uint32_t>(t[2])});
  }
  for (const sim::Vec3& vertex : mesh.vertices) {
    result.positions.push_back(centre + vertex.cast<float>());
    result.normals.push_back(vertex.cast<float>().normalized());
  }
  result.shape = shape;
  return result;
}

TEST(RoundingRoom, IsNoneWhereBodiesTouchAndNotLimitedFarAway) {
  std::vector<render::Mesh> meshes = {ball({0, 0, 0}), ball({2, 0, 0}), ball({0, 0, 50})};
  set_rounding_room(meshes);
  const auto [least, most] = std::minmax_element(meshes[0].room.begin(), meshes[0].room.end());
  EXPECT_LT(*least, 1e-6f);
  EXPECT_TRUE(std::isinf(*most));
  for (const float room : meshes[2].room) EXPECT_TRUE(std::isinf(room));
}

TEST(RoundingRoom, KeepsBodiesApartThatAreApart) {
  // A plane halfway between two balls of equal meshes: each stays on its side of it, wherever the
  // gap between their nearest vertices lies.
  for (const float gap : {0.001f, 0.01f, 0.05f, 0.2f}) {
    std::vector<render::Mesh> meshes = {ball({0, 0, 0}), ball({2 + gap, 0, 0})};
    set_rounding_room(meshes);
    const render::Mesh& mesh = meshes[0];
    const std::vector<float> share =
        render::bulge_shares(mesh.shape->triangles, mesh.positions, mesh.normals, mesh.room);
    float furthest = 0.0f;
    for (const render::Triangle& t : mesh.shape->triangles) {
      for (int i = 0; i <= 8; ++i) {
        for (int j = 0; i + j <= 8; ++j) {
          const float a = 0.125f * static_cast<float>(i);
          const float b = 0.125f * static_cast<float>(j);
          const render::SurfacePoint point = {t, {1 - a - b, a, b}};
          furthest = std::max(
              furthest, render::rounded_position(mesh.positions, mesh.normals, share, point).x());
        }
      }
    }
    EXPECT_LE(furthest, 1.0f + 0.5f * gap + 1e-6f) << gap;
  }
}

TEST(RoundingRoom, IsForSmoothCoarseMeshesOnly) {
  std::vector<render::Mesh> meshes = {ball({0, 0, 0})};
  meshes[0].normals.clear();
  set_rounding_room(meshes);
  EXPECT_TRUE(meshes[0].room.empty());
}

}  // namespace
}  // namespace pneuma::app

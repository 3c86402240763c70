#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "sim/collision/point_in_body.h"
#include "sim/collision/separating_axis.h"
#include "sim/inspect/inspect.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

/// Overlaps of known depth, without a ground unless a test wants one.
World empty_world() {
  World world;
  world.settings.ground.reset();
  return world;
}

/// A cube of soft skin with flat faces, 3 m wide: 3 x 3 squares a face.
SoftBody soft_cube(const Vec3& offset) { return make_body(make_box({3.0, 3.0, 3.0}, 3), offset); }

constexpr double rounding = 1e-14;  // of places of a few metres

TEST(Penetration, NothingOverlapsNothing) {
  World world;
  EXPECT_EQ(max_penetration(world), 0.0);
  world = empty_world();
  world.soft.push_back(soft_cube(Vec3::Zero()));
  world.soft.push_back(soft_cube({3.1, 0.0, 0.0}));
  world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.0, 2.1, 0.0}));
  world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.0, 3.2, 0.0}));
  EXPECT_EQ(max_penetration(world), 0.0);
}

TEST(Penetration, IntoTheGround) {
  World world;
  world.soft.push_back(soft_cube({0.0, 0.0, 1.2}));
  EXPECT_NEAR(max_penetration(world), 0.3, rounding);
  world.rigid.push_back(make_rigid({2.0, 2.0, 2.0}, {10.0, 0.0, 1.0}));
  world.rigid[0].orientation =
      Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 4.0, Vec3::UnitX()));
  EXPECT_NEAR(max_penetration(world), std::numbers::sqrt2 - 1.0, rounding) << "on its edge";
  world.settings.ground.reset();
  EXPECT_EQ(max_penetration(world), 0.0);
}

TEST(Penetration, OfTwoSoftBodiesIsTheDeepestVertexsWhicheverIsInside) {
  for (const bool swapped : {false, true}) {
    // Shifted across as well, so that no vertex lies on a face: 0.25 m deep, to the face x = 1.5.
    World world = empty_world();
    world.soft.push_back(soft_cube(Vec3::Zero()));
    world.soft.push_back(make_body(make_box({1.0, 1.0, 1.0}, 1), {1.75, 0.2, 0.1}));
    if (swapped) std::swap(world.soft[0], world.soft[1]);
    EXPECT_NEAR(max_penetration(world), 0.25, rounding);
  }
}

TEST(Penetration, OfABoxInASoftBodyIsItsCorners) {
  World world = empty_world();
  world.soft.push_back(soft_cube(Vec3::Zero()));
  world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.2, 0.1, 1.8}));
  EXPECT_NEAR(max_penetration(world), 0.2, rounding);
}

TEST(Penetration, OfASoftBodyInABoxIsItsVertices) {
  World world = empty_world();
  world.soft.push_back(make_body(make_box({1.0, 1.0, 1.0}, 1), {0.2, 0.1, 2.4}));
  world.rigid.push_back(make_rigid({4.0, 4.0, 4.0}, Vec3::Zero()));
  EXPECT_NEAR(max_penetration(world), 0.1, rounding);
}

TEST(Penetration, OfTwoBoxesIsTheShortestWayApart) {
  World world = empty_world();
  world.rigid.push_back(make_rigid({2.0, 2.0, 2.0}, Vec3::Zero()));
  world.rigid.push_back(make_rigid({2.0, 2.0, 2.0}, {1.9, 1.0, -0.5}));
  EXPECT_NEAR(max_penetration(world), 0.1, rounding);
  // An edge ahead, turned by 45 degrees: it reaches 1.414 from its centre.
  world.rigid[1].position = {2.3, 0.0, 0.0};
  world.rigid[1].orientation =
      Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 4.0, Vec3::UnitZ()));
  EXPECT_NEAR(max_penetration(world), 1.0 + std::numbers::sqrt2 - 2.3, rounding);
}

TEST(Penetration, IsTheGreatestOfAll) {
  World world;
  world.soft.push_back(soft_cube({0.0, 0.0, 1.45}));                     // 0.05 in the ground
  world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.2, 0.1, 3.25}));  // 0.2 in the soft cube
  world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.3, 0.2, 4.15}));  // 0.1 in the box below
  EXPECT_NEAR(max_penetration(world), 0.2, rounding);
}

/// Vertices, middles of edges, middles of triangles.
std::vector<Vec3> points_of(const SurfaceView& surface) {
  const VertexArray& x = surface.positions;
  std::vector<Vec3> points;
  for (int v = 0; v < x.size(); ++v) points.emplace_back(x[v]);
  for (const auto& [a, b] : surface.topology.edges()) points.emplace_back(0.5 * (x[a] + x[b]));
  for (const auto& [a, b, c] : surface.topology.triangles()) {
    points.emplace_back((x[a] + x[b] + x[c]) / 3.0);
  }
  return points;
}

/// All points of a 6 x 6 x 6 lattice that lie on an edge of the box.
std::vector<Vec3> points_of_box(const OrientedBox& box) {
  std::vector<Vec3> points;
  for (int i = 0; i < 6 * 6 * 6; ++i) {
    const Vec3 share = Vec3(i % 6, i / 6 % 6, i / 36) / 5.0;
    const auto at_end = (share.array() == 0.0) || (share.array() == 1.0);
    if (at_end.count() < 2) continue;
    points.push_back(box.to_world((2.0 * share - Vec3::Ones()).cwiseProduct(box.half)));
  }
  return points;
}

TEST(Penetration, OfAHundredCubesOnATorusIsThatOfAllPairs) {
  // Every pair looked at, by the plain definition: no spheres about the bodies, no bounds.
  World world = empty_world();
  world.soft.push_back(make_body(make_torus(6.0, 2.0, 16, 16), {0.0, 0.0, 2.0}));
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&]() -> Vec3 { return {uniform(random), uniform(random), uniform(random)}; };
  for (int i = 0; i < 100; ++i) {
    world.rigid.push_back(make_rigid(
        {1.0, 0.8, 1.2}, Vec3(9.0, 9.0, 3.0).cwiseProduct(vector()) + 3.0 * Vec3::UnitZ()));
    const double angle = 3.0 * uniform(random);
    world.rigid.back().orientation = Eigen::AngleAxisd(angle, vector().normalized());
  }
  while (world.rigid.size() > 3) {
    std::vector<OrientedBox> boxes;
    for (const RigidBox& box : world.rigid) {
      boxes.push_back({box.position, box.orientation.toRotationMatrix(), 0.5 * box.size});
    }
    const VertexArray& vertices = world.soft[0].positions;
    const SurfaceView surface{world.soft[0].mesh->topology, vertices};
    TriangleColumns columns;
    columns.fill(surface);
    const std::vector<Vec3> points_of_surface = points_of(surface);
    double expected = 0.0;
    std::size_t deepest = 0;
    const auto meet = [&](double depth, std::size_t box) {
      if (depth <= expected) return;
      expected = depth;
      deepest = box;
    };
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (const Vec3& point : points_of_surface) {
        if (const auto exit = find_box_exit(boxes[i], point)) meet(exit->depth, i);
      }
      for (const Vec3& point : points_of_box(boxes[i])) {
        const auto exit = find_surface_exit(surface, columns, point);
        if (exit) meet(exit->depth, i);
      }
      for (std::size_t j = i + 1; j < boxes.size(); ++j) {
        if (const auto overlap = find_min_overlap(boxes[i], boxes[j])) meet(overlap->overlap, i);
      }
    }
    // The same points but for the rounding of their places, which reach 12 m.
    ASSERT_NEAR(max_penetration(world), expected, 1e-13);
    // Again without the deepest, and a few more of them: shallow ones and other kinds get their
    // turn.
    world.rigid.erase(world.rigid.begin() + static_cast<std::ptrdiff_t>(deepest));
    world.rigid.resize(world.rigid.size() * 4 / 5);
  }
}

}  // namespace
}  // namespace pneuma::sim

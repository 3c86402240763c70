// The deepest point against all pairs of bodies; depths that are known: inspect/overlap_test.cpp.
#include <gtest/gtest.h>

#include <random>

#include "sim/collision/point_in_body.h"
#include "sim/collision/separating_axis.h"
#include "sim/inspect/inspect.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

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
  World world;
  world.settings.ground.reset();
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

/// Two boxes 0.1 m in each other, 0.05 m in the ground, and a ball 0.3 m in the second.
World three_overlaps() {
  World world;
  world.soft.push_back(make_body(make_icosphere(1.0, 3), {4.6, 0.0, 1.5}));
  world.rigid.push_back(make_rigid({2.0, 2.0, 2.0}, {0.0, 0.0, 0.95}));
  world.rigid.push_back(make_rigid({2.0, 2.0, 2.0}, {1.9, 0.0, 1.5}));
  return world;
}

void expect_deepest(const World& world, int first, int second, double depth,
                    double tolerance = 1e-12) {
  const Overlap deepest = deepest_penetration(world);
  EXPECT_EQ(deepest.first, first);
  EXPECT_EQ(deepest.second, second);
  EXPECT_NEAR(deepest.depth, depth, tolerance);
}

TEST(Penetration, NamesTheBodiesThatLieDeepest) {
  World world = three_overlaps();
  for (int v = 0; v < world.soft[0].positions.size(); ++v) world.soft[0].positions[v].x() -= 1.0;
  // The ball's mesh lies within its sphere, and its depth is that of the nearest of its points.
  expect_deepest(world, 0, 2, 0.3, 0.01);
  world = three_overlaps();
  expect_deepest(world, 1, 2, 0.1);
  world.rigid[1].position.y() += 5.0;
  expect_deepest(world, 1, ground_body, 0.05);
  world.settings.ground.reset();
  EXPECT_EQ(max_penetration(world), 0.0);
}

}  // namespace
}  // namespace pneuma::sim

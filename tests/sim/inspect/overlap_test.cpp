#include "sim/inspect/overlap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <ostream>
#include <random>
#include <string>

#include "sim/collision/oriented_box.h"
#include "sim/collision/point_in_body.h"
#include "sim/inspect/inspect.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

double deepest_overlap(const World& world) {
  double depth = 0.0;
  for (const Overlap& overlap : overlaps(world)) depth = std::max(depth, overlap.depth);
  return depth;
}

/// Overlaps of known depth, without a ground unless a test wants one.
World empty_world() {
  World world;
  world.settings.ground.reset();
  return world;
}

/// A cube of soft skin with flat faces, 3 m wide: 3 x 3 squares a face.
SoftBody soft_cube(const Vec3& offset) { return make_body(make_box({3.0, 3.0, 3.0}, 3), offset); }

constexpr double rounding = 1e-14;  // of places of a few metres

/// What two measures agree on, penetration and overlap: depths where one body is in the other by
/// its vertices or corners alone.
struct Measure {
  std::string name;
  double (*depth)(const World&);
};

void PrintTo(const Measure& measure, std::ostream* out) { *out << measure.name; }

class KnownDepth : public testing::TestWithParam<Measure> {
 protected:
  static double depth(const World& world) { return GetParam().depth(world); }
};

INSTANTIATE_TEST_SUITE_P(Measures, KnownDepth,
                         testing::Values(Measure{"penetration", max_penetration},
                                         Measure{"overlap", deepest_overlap}),
                         [](const auto& measure) { return measure.param.name; });

TEST_P(KnownDepth, NothingOverlapsNothing) {
  World world;
  EXPECT_EQ(depth(world), 0.0);
  world = empty_world();
  world.soft.push_back(soft_cube(Vec3::Zero()));
  world.soft.push_back(soft_cube({3.1, 0.0, 0.0}));
  world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.0, 2.1, 0.0}));
  world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.0, 3.2, 0.0}));
  EXPECT_EQ(depth(world), 0.0);
}

TEST_P(KnownDepth, IntoTheGround) {
  World world;
  world.soft.push_back(soft_cube({0.0, 0.0, 1.2}));
  EXPECT_NEAR(depth(world), 0.3, rounding);
  world.rigid.push_back(make_rigid({2.0, 2.0, 2.0}, {10.0, 0.0, 1.0}));
  world.rigid[0].orientation =
      Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 4.0, Vec3::UnitX()));
  EXPECT_NEAR(depth(world), std::numbers::sqrt2 - 1.0, rounding) << "on its edge";
  world.settings.ground.reset();
  EXPECT_EQ(depth(world), 0.0);
}

TEST_P(KnownDepth, OfTwoSoftBodiesIsTheDeepestVertexsWhicheverIsInside) {
  for (const bool swapped : {false, true}) {
    // Shifted across as well, so that no vertex lies on a face: 0.25 m deep, to the face x = 1.5.
    World world = empty_world();
    world.soft.push_back(soft_cube(Vec3::Zero()));
    world.soft.push_back(make_body(make_box({1.0, 1.0, 1.0}, 1), {1.75, 0.2, 0.1}));
    if (swapped) std::swap(world.soft[0], world.soft[1]);
    EXPECT_NEAR(depth(world), 0.25, rounding);
  }
}

TEST_P(KnownDepth, OfABoxInASoftBodyIsItsCorners) {
  World world = empty_world();
  world.soft.push_back(soft_cube(Vec3::Zero()));
  world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.2, 0.1, 1.8}));
  EXPECT_NEAR(depth(world), 0.2, rounding);
}

TEST_P(KnownDepth, OfASoftBodyInABoxIsItsVertices) {
  World world = empty_world();
  world.soft.push_back(make_body(make_box({1.0, 1.0, 1.0}, 1), {0.2, 0.1, 2.4}));
  world.rigid.push_back(make_rigid({4.0, 4.0, 4.0}, Vec3::Zero()));
  EXPECT_NEAR(depth(world), 0.1, rounding);
}

TEST_P(KnownDepth, OfTwoBoxesIsTheShortestWayApart) {
  World world = empty_world();
  world.rigid.push_back(make_rigid({2.0, 2.0, 2.0}, Vec3::Zero()));
  world.rigid.push_back(make_rigid({2.0, 2.0, 2.0}, {1.9, 1.0, -0.5}));
  EXPECT_NEAR(depth(world), 0.1, rounding);
  // An edge ahead, turned by 45 degrees: it reaches 1.414 from its centre.
  world.rigid[1].position = {2.3, 0.0, 0.0};
  world.rigid[1].orientation =
      Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 4.0, Vec3::UnitZ()));
  EXPECT_NEAR(depth(world), 1.0 + std::numbers::sqrt2 - 2.3, rounding);
}

TEST_P(KnownDepth, IsTheGreatestOfAll) {
  World world;
  world.soft.push_back(soft_cube({0.0, 0.0, 1.45}));                     // 0.05 in the ground
  world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.2, 0.1, 3.25}));  // 0.2 in the soft cube
  world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.3, 0.2, 4.15}));  // 0.1 in the box below
  EXPECT_NEAR(depth(world), 0.2, rounding);
}

TEST(Overlaps, OfCoincidentBallsIsTheirDiameterAndShrinksAsTheyPart) {
  // Faceted: a ball of 24 x 24 has an inscribed radius of 0.98 of its own.
  double last = std::numeric_limits<double>::infinity();
  for (const double apart : {0.0, 0.5, 1.0, 2.0, 3.0, 3.9, 5.0}) {
    World world = empty_world();
    world.soft.push_back(make_body(make_sphere(2.0, 24, 24)));
    world.soft.push_back(make_body(make_sphere(2.0, 24, 24), {apart, 0.0, 0.0}));
    const double depth = deepest_overlap(world);
    EXPECT_NEAR(depth, std::max(0.0, 4.0 - apart), 0.08) << apart;
    EXPECT_LE(depth, last);
    last = depth;
  }
}

TEST(Overlaps, OfCoincidentToriIsTheThicknessOfTheirTubes) {
  World world = empty_world();
  for (int i = 0; i < 2; ++i) world.soft.push_back(make_body(make_torus(4.0, 1.0, 32, 24)));
  EXPECT_NEAR(deepest_overlap(world), 2.0, 0.08);
}

TEST(Overlaps, OfARodThroughABallIsTheBallsRadiusAndHalfTheRod) {
  // However long the rod is, and however it lies; soft rods too.
  for (const double length : {12.0, 40.0, 400.0}) {
    for (const double angle : {0.0, 0.4, 1.1}) {
      const Vec3 axis = Vec3(0.3, 1.0, 0.2).normalized();
      World world = empty_world();
      world.soft.push_back(make_body(make_sphere(3.5, 16, 16)));
      world.rigid.push_back(make_rigid({length, 0.3, 0.3}, {0.07, 0.0, 0.0}));
      world.rigid[0].orientation = Eigen::AngleAxisd(angle, axis);
      EXPECT_NEAR(deepest_overlap(world), 3.65, 0.15) << length << ' ' << angle;
      world.rigid.clear();
      SoftBody rod = make_body(make_box({length, 0.3, 0.3}, 1));
      for (int v = 0; v < rod.positions.size(); ++v) {
        const Vec3 turned = Eigen::AngleAxisd(angle, axis) * Vec3(rod.positions[v]);
        rod.positions[v] = turned;
      }
      world.soft.push_back(rod);
      EXPECT_NEAR(deepest_overlap(world), 3.65, 0.15) << length << ' ' << angle << " soft";
    }
  }
}

TEST(Overlaps, OfAPlateThroughABallIsTheBallsRadiusAndHalfThePlate) {
  World world = empty_world();
  world.soft.push_back(make_body(make_sphere(3.5, 16, 16)));
  world.rigid.push_back(make_rigid({10.0, 10.0, 0.1}, {0.3, 0.2, 0.0}));
  world.rigid[0].orientation = Eigen::AngleAxisd(0.5, Vec3(1.0, 2.0, 0.0).normalized());
  // Its middle plane passes 0.086 m from the ball's centre.
  EXPECT_NEAR(deepest_overlap(world), 3.5 - 0.086 + 0.05, 0.12);
}

TEST(Overlaps, NameBothBodiesOfEachPair) {
  World world;
  world.soft.push_back(soft_cube({0.0, 0.0, 1.45}));                     // 0.05 in the ground
  world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.2, 0.1, 3.25}));  // 0.2 in the soft cube
  world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.3, 0.2, 4.15}));  // 0.1 in the box below
  const std::vector<Overlap> found = overlaps(world);
  ASSERT_EQ(found.size(), 3U);
  const struct {
    int first, second;
    double depth;
  } expected[] = {{0, ground_body, 0.05}, {0, 1, 0.2}, {1, 2, 0.1}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found[i].first, expected[i].first);
    EXPECT_EQ(found[i].second, expected[i].second);
    EXPECT_NEAR(found[i].depth, expected[i].depth, rounding);
  }
}

TEST(Overlaps, OfRandomCubesAndATorusAreTheGreatestSumsOfDepths) {
  // The plain definition on a lattice of 5 cm. A lattice point in both bodies lies within 0.1 m of
  // the deepest point, and on the way the sum changes by at most twice that.
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&]() -> Vec3 {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return {x, y, z};
  };
  World world = empty_world();
  world.soft.push_back(make_body(make_torus(6.0, 2.0, 16, 16)));
  const SurfaceView torus{world.soft[0].mesh->topology, world.soft[0].positions};
  TriangleColumns columns;
  columns.fill(torus);
  int overlapping = 0;
  for (int i = 0; i < 40; ++i) {
    world.rigid = {make_rigid({1.0, 0.8, 1.2}, Vec3(9.0, 9.0, 3.0).cwiseProduct(vector()))};
    const double angle = 3.0 * uniform(random);  // compilers differ in the order of arguments
    world.rigid[0].orientation = Eigen::AngleAxisd(angle, vector().normalized());
    const OrientedBox box{world.rigid[0].position, world.rigid[0].orientation.toRotationMatrix(),
                          0.5 * world.rigid[0].size};
    double expected = 0.0;
    for (int k = 0; k < 20 * 16 * 24; ++k) {
      const Vec3 cell(k % 20 + 0.5, k / 20 % 16 + 0.5, k / 320 + 0.5);
      const Vec3 point = box.to_world(0.05 * cell - box.half);
      const auto in_torus = find_surface_exit(torus, columns, point);
      if (in_torus)
        expected = std::max(expected, find_box_exit(box, point)->depth + in_torus->depth);
    }
    const double depth = deepest_overlap(world);
    EXPECT_GE(depth, 0.95 * expected) << i;
    EXPECT_LE(depth, expected + 0.2) << i;
    overlapping += depth > 0.1;
    // What ends sooner finds the same pairs, and which are deeper.
    for (const double enough : {0.0, 0.1, 0.5}) {
      EXPECT_EQ(overlap_deeper_than(world, 0, 1, enough), depth > enough) << i;
      const auto found = overlaps(world, [&](int, int) { return enough; });
      ASSERT_EQ(found.size(), depth > 0.0 ? 1U : 0U) << i;
      for (const Overlap& pair : found) EXPECT_EQ(pair.depth > enough, depth > enough) << i;
    }
  }
  EXPECT_GT(overlapping, 10);
}

}  // namespace
}  // namespace pneuma::sim

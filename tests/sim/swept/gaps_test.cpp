// What rests on a body lies on it, however large that is (ERRATA row 67).
#include <gtest/gtest.h>

#include "tests/sim/swept/swept_worlds.h"

namespace pneuma::sim {
namespace {

/// A block of 10 m and 1000 kg on the ground.
World make_block() {
  World world = make_swept_world();
  world.rigid = {make_rigid(Vec3::Constant(10.0), {0.0, 0.0, 5.0}, 1000.0)};
  return world;
}

double lowest(const SoftBody& body) { return body.positions.rows().row(2).minCoeff(); }

/// Also one that starts within the distance that the block would keep from its like.
TEST(Gaps, ASmallCubeLiesOnALargeOne) {
  for (const double side : {0.05, 0.2, 1.0}) {
    for (const double start : {0.02, 0.2}) {
      World world = make_block();
      world.rigid.push_back(
          make_rigid(Vec3::Constant(side), {1.0, 0.5, 10.0 + side * (0.5 + start)}, side * side));
      ASSERT_FALSE(run(world, 2.0));
      const double top = world.rigid[0].position.z() + 5.0;
      const double gap = world.rigid[1].position.z() - 0.5 * side - top;
      // Twice its own skin of a 400th of its side, and half as much more, up to which boxes touch.
      EXPECT_LT(gap, 0.0075 * side + 1e-4) << side << " " << start;
      EXPECT_GT(gap, -0.002 * side) << side << " " << start;
    }
  }
}

TEST(Gaps, ASmallBallLiesOnALargeCube) {
  World world = make_block();
  SoftBody ball = make_body(make_icosphere(0.05, 2), {0.0, 0.0, 10.06});
  ball.material.k = 10.0;
  ball.material.n = 1e-5;
  ball.material.vertex_mass = 0.01 / ball.positions.size();
  world.soft = {ball};
  world.settings.steps_per_second = 960;
  ASSERT_FALSE(run(world, 2.0));
  const double gap = lowest(world.soft[0]) - (world.rigid[0].position.z() + 5.0);
  // Twice its skin, a hundredth of its edges of 2.7 cm, is 0.5 mm; it may still bounce.
  EXPECT_LT(gap, 1e-3);
}

/// Above a block that falls, nearer than blocks of its size keep.
TEST(Gaps, ACubeAboveABlockFallsWithIt) {
  World world = make_swept_world();
  world.rigid = {make_rigid(Vec3::Constant(100.0), {0.0, 0.0, 51.0}, 1e6),
                 make_rigid(Vec3::Ones(), {0.0, 0.0, 101.6}),
                 make_rigid(Vec3::Constant(1e-3), {80.0, 0.0, 5e-4}, 1e-9)};
  const auto divergence = run(world, 2.0);
  ASSERT_FALSE(divergence) << divergence->what;
  EXPECT_NEAR(world.rigid[1].position.z() - world.rigid[0].position.z(), 50.5, 0.01);
}

}  // namespace
}  // namespace pneuma::sim

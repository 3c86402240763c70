// Soft bodies that slide over boxes side by side do not feel where these join (ERRATA row 67).
#include <gtest/gtest.h>

#include "sim/inspect/crossings.h"
#include "tests/sim/swept/swept_worlds.h"

namespace pneuma::sim {
namespace {

constexpr double speed = 4.0;  // m/s

/// Static boxes without friction from x = -10 to 10, of which every second has its top at `step`
/// (m) in place of 0, with a `gap` (m) between them, and a ball that slides over them.
World make_tiles(int tiles, double gap, double step, int subdivisions, int steps_per_second) {
  World world = make_swept_world();
  world.settings.ground.reset();
  world.settings.steps_per_second = steps_per_second;
  const double width = 20.0 / tiles;
  for (int i = 0; i < tiles; ++i) {
    const Vec3 place(-10.0 + (i + 0.5) * width, 0.0, -0.5 + (i % 2 == 0 ? 0.0 : step));
    world.rigid.push_back(make_rigid({width - gap, 6.0, 1.0}, place));
    world.rigid.back().is_kinematic = true;
    world.rigid.back().surface = {0.0, 0.0};
  }
  world.soft.push_back(make_sliding_ball(subdivisions, {-7.03, 0.03, 1.01}, {speed, 0.0, 0.0}));
  return world;
}

/// Each of ten seams took 1 to 5 % of the speed.
TEST(SoftSeams, DoNotBrakeABall) {
  for (const int subdivisions : {1, 2}) {
    for (const int steps_per_second : {480, 960}) {
      World world = make_tiles(16, 0.0, 0.0, subdivisions, steps_per_second);
      ASSERT_FALSE(run(world, 3.0));
      // What is left: a vertex that a seam lifts by less than the distance that it keeps.
      EXPECT_GT(mean(world.soft[0].velocities).x(), 0.99 * speed)
          << subdivisions << " " << steps_per_second;
      EXPECT_EQ(crossings(world).between_bodies, 0);
    }
  }
}

/// Half a millimetre apart, and every second tile lower by as much: less than the ball keeps.
TEST(SoftSeams, OfTilesThatAreLaidRoughlyBrakeABallLittle) {
  World world = make_tiles(16, 5e-4, -5e-4, 2, 480);
  ASSERT_FALSE(run(world, 3.0));
  EXPECT_GT(mean(world.soft[0].velocities).x(), 0.95 * speed);
}

/// A tile that stands out does stop it.
TEST(SoftSeams, ThatAreStepsStopABall) {
  World world = make_tiles(2, 0.0, 0.8, 2, 480);
  ASSERT_FALSE(run(world, 2.5));
  EXPECT_LT(mean(world.soft[0].positions).x(), 0.0);
  EXPECT_EQ(crossings(world).between_bodies, 0);
}

}  // namespace
}  // namespace pneuma::sim

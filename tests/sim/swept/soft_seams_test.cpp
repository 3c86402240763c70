// Soft bodies that slide over boxes side by side do not feel where these join (ERRATA row 67).
#include <gtest/gtest.h>

#include "sim/equilibrium/held_shape.h"
#include "sim/inspect/crossings.h"
#include "sim/inspect/inspect.h"
#include "tests/sim/swept/swept_worlds.h"

namespace pneuma::sim {
namespace {

constexpr double speed = 4.0;  // m/s

SoftBody make_smooth_ball(int subdivisions, const Vec3& position) {
  SoftBody ball = make_body(make_icosphere(1.0, subdivisions), position);
  ball.material.n = 300.0 * volume_of(ball) / (gas_constant * ball.material.temperature);
  ball.material.k = 900.0;
  ball.material.vertex_mass = 10.0 / ball.positions.size();
  ball.material.rho_g = 0.0;
  ball.material.surface = {0.0, 0.0};
  ball.mesh = held_mesh(*ball.mesh, ball.positions, ball.material);
  for (int v = 0; v < ball.velocities.size(); ++v) ball.velocities[v].x() = speed;
  return ball;
}

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
  world.soft.push_back(make_smooth_ball(subdivisions, {-7.03, 0.03, 1.01}));
  return world;
}

/// They pass ten seams, of which each took 1 to 5 % of the speed.
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

// Soft bodies roll and slide on slopes that are nearly flat: no step takes motion that they share.
#include <gtest/gtest.h>

#include "sim/equilibrium/held_shape.h"
#include "sim/inspect/inspect.h"
#include "tests/sim/swept/swept_worlds.h"

namespace pneuma::sim {
namespace {

/// On a static slab in a gravity that pulls sideways by a little.
World make_ball_on_slope(double pull, double speed, double friction) {
  World world = make_swept_world();
  world.settings.gravity.x() = -pull;
  world.settings.ground.reset();
  SoftBody ball = make_body(make_icosphere(1.0, 2), {0.0, 0.0, 1.002});
  ball.material.n = 100.0 * volume_of(ball) / (gas_constant * ball.material.temperature);
  ball.material.vertex_mass = 1.0 / ball.positions.size();
  ball.material.rho_g = 0.0;
  ball.material.surface = {0.0, friction};
  ball.mesh = held_mesh(*ball.mesh, ball.positions, ball.material);
  for (int v = 0; v < ball.velocities.size(); ++v) ball.velocities[v].x() = speed;
  world.soft = {ball};
  world.rigid = {make_rigid({100.0, 20.0, 1.0}, {0.0, 0.0, -0.5})};
  world.rigid[0].is_kinematic = true;
  world.rigid[0].surface = {0.0, friction};
  return world;
}

double place(const World& world) { return mean(world.soft[0].positions).x(); }

/// Without friction: x = v t - a t^2 / 2.
TEST(GentleSlopes, ABallSlidesUpAndComesBack) {
  constexpr double pull = 0.2, speed = 1.6, time = 2.0 * speed / pull;
  for (const int steps_per_second : {90, 120, 240}) {
    World world = make_ball_on_slope(pull, speed, 0.0);
    world.settings.steps_per_second = steps_per_second;
    ASSERT_FALSE(run(world, time / 2.0));
    EXPECT_NEAR(place(world), speed * speed / (2.0 * pull), 0.01) << steps_per_second;
    ASSERT_FALSE(run(world, time / 2.0));
    EXPECT_NEAR(place(world), 0.0, 0.02) << steps_per_second;
  }
}

/// Of a slope of 2.3 degrees.
TEST(GentleSlopes, ABallRollsBack) {
  for (const int steps_per_second : {120, 240}) {
    World world = make_ball_on_slope(0.4, 1.2, 0.5);
    world.settings.steps_per_second = steps_per_second;
    ASSERT_FALSE(run(world, 12.0));
    EXPECT_LT(place(world), -3.0) << steps_per_second;
  }
}

}  // namespace
}  // namespace pneuma::sim

// What counts as quiet before a body falls asleep (ERRATA row 71), of motions that are given.
#include <gtest/gtest.h>

#include "sim/response/fall_asleep.h"
#include "sim/response/motion_start.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

/// A soft body of 1 m and, as one body alone never sleeps, a box.
World make_ball_and_box() {
  World world;
  world.settings.steps_per_second = 1000;
  world.soft = {make_body(make_icosphere(0.5, 1))};
  world.rigid = {make_rigid(Vec3::Ones(), {5.0, 0.0, 0.0})};
  return world;
}

/// How many steps of two seconds were the last quiet ones, where each moves a body by `way` (m) and
/// the next takes it back.
int quiet_steps_of(World world, int body, double way) {
  FallAsleep fall_asleep(world);
  MotionStart start;
  for (int i = 0; i < 2 * world.settings.steps_per_second; ++i) {
    keep_soft(world, start.soft);
    keep_rigid(world, start.rigid);
    const Vec3 moved = (i % 2 == 0 ? way : -way) * Vec3::UnitX();
    if (body == 0) {
      VertexArray& positions = world.soft[0].positions;
      for (int v = 0; v < positions.size(); ++v) positions[v] += moved;
    } else {
      world.rigid[0].position += moved;
    }
    fall_asleep.count_quiet_steps(world, start);
  }
  return world.rest[at(body)].quiet_steps;
}

/// It stays within a millimetre, but so fast do contacts not shake what they hold: in a step by
/// what gravity gives in two.
TEST(QuietSteps, AreNotThoseOfASoftBodyThatRings) {
  const World world = make_ball_and_box();
  const double step = time_step(world.settings),
               shaken = 2.0 * world.settings.gravity.norm() * step * step;
  EXPECT_EQ(quiet_steps_of(world, 0, 0.9 * shaken), 1000);  // of a second
  EXPECT_EQ(quiet_steps_of(world, 0, 1.1 * shaken), 0);
}

/// Where gravity is weak, and at last none, what drifts is not at rest, however slow.
TEST(QuietSteps, AreFewerInWeakGravity) {
  World world = make_ball_and_box();
  const double way = 0.5 * world.settings.sleep_speed * time_step(world.settings);
  EXPECT_EQ(quiet_steps_of(world, 1, way), 500);  // of half a second
  world.settings.gravity = {0.0, 0.0, -3.0};      // 0.6 of the speed of rest
  EXPECT_EQ(quiet_steps_of(world, 1, way), 500);
  world.settings.gravity = {0.0, 0.0, -2.0};  // 0.4
  EXPECT_EQ(quiet_steps_of(world, 1, way), 0);
  world.settings.gravity = Vec3::Zero();
  EXPECT_EQ(quiet_steps_of(world, 1, 1e-9 * way), 0);
  EXPECT_EQ(quiet_steps_of(world, 1, 0.0), 500);
  EXPECT_EQ(quiet_steps_of(world, 0, 1e-9 * way), 0);
  EXPECT_EQ(quiet_steps_of(world, 0, 0.0), 1000);
}

}  // namespace
}  // namespace pneuma::sim

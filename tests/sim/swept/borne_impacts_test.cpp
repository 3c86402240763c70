// What bounces while something else bears it: the ground pushes a box in the step in which it comes
// to a wall, to another box or under one that falls (ERRATA row 67).
#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/swept/swept_worlds.h"

namespace pneuma::sim {
namespace {

constexpr double g = 9.81;  // m/s^2
/// Of a speed: what is left of a solution.
constexpr double solved = 1e-4;

RigidBox smooth_cube(double side, double x, double restitution) {
  RigidBox cube = make_rigid({side, side, side}, {x, 0.0, 0.5 * side});
  cube.surface = {restitution, 0.0};
  cube.rho_g = 0.0;
  return cube;
}

/// Calls `check` with worlds with a smooth ground, each with restitutions and parts from 0 to 1.
template <class Check>
void for_many(const Check& check) {
  for (const int steps_per_second : {60, 240, 960}) {
    for (const double restitution : {0.5, 0.8, 1.0}) {
      for (double part = 0.0; part < 1.0; part += 0.05) {
        World world = make_swept_world();
        world.settings.ground = ContactMaterial{0.0, 0.0};
        world.settings.gravity = {0.0, 0.0, -g};
        world.settings.steps_per_second = steps_per_second;
        SCOPED_TRACE(testing::Message() << steps_per_second << " " << restitution << " " << part);
        check(world, restitution, part);
      }
    }
  }
}

TEST(BorneImpacts, ABoxBouncesOffAWall) {
  for_many([](World& world, double restitution, double part) {
    const double speed = 2.0 + 3.0 * part;
    world.rigid = {smooth_cube(0.5, -1.0, restitution), smooth_cube(0.5, 0.0, restitution)};
    world.rigid[0].velocity.x() = speed;
    world.rigid[1].is_kinematic = true;
    ASSERT_FALSE(run(world, 0.6));
    EXPECT_NEAR(world.rigid[0].velocity.x(), -restitution * speed, solved * speed);
  });
}

/// Slower than four steps of free fall, in which it comes to the wall within the step.
TEST(BorneImpacts, ASlowBoxBouncesOffAWall) {
  for (double speed = 0.2; speed < 1.0; speed += 0.05) {
    World world = make_swept_world();
    world.settings.ground = ContactMaterial{0.0, 0.0};
    world.settings.gravity = {0.0, 0.0, -g};
    world.settings.steps_per_second = 240;
    world.rigid = {smooth_cube(0.5, -0.6, 0.5), smooth_cube(0.5, 0.0, 0.5)};
    world.rigid[0].velocity.x() = speed;
    world.rigid[1].is_kinematic = true;
    ASSERT_FALSE(run(world, 0.2 / speed));
    EXPECT_NEAR(world.rigid[0].velocity.x(), -0.5 * speed, solved * speed) << speed;
  }
}

TEST(BorneImpacts, ABoxHitsAnotherAsHeavy) {
  for_many([](World& world, double restitution, double part) {
    const double speed = 2.0 + 3.0 * part;
    world.rigid = {smooth_cube(0.5, -1.0, restitution), smooth_cube(0.5, 0.0, restitution)};
    world.rigid[0].velocity.x() = speed;
    ASSERT_FALSE(run(world, 0.6));
    EXPECT_NEAR(world.rigid[0].velocity.x(), 0.5 * (1.0 - restitution) * speed, solved * speed);
    EXPECT_NEAR(world.rigid[1].velocity.x(), 0.5 * (1.0 + restitution) * speed, solved * speed);
  });
}

TEST(BorneImpacts, ABoxBouncesOffOneThatLiesOnTheGround) {
  for_many([](World& world, double restitution, double part) {
    const double height = 0.2 + 0.4 * part;
    world.rigid = {smooth_cube(1.0, 0.0, 0.0), smooth_cube(0.5, 0.0, restitution)};
    world.rigid[0].mass = 1e4;
    const RigidBox& cube = world.rigid[1];
    world.rigid[1].position.z() = 1.25 + height;
    const double falls = std::sqrt(2.0 * height / g), step = time_step(world.settings);
    ASSERT_FALSE(run(world, falls + 2.0 * step));
    const double speed = cube.velocity.z();
    const double rises = cube.position.z() - 1.25 + speed * speed / (2.0 * g);
    EXPECT_GT(speed, 0.0);
    // They are in contact up to one and a half times the distance that they keep, 5 mm; and half of
    // what a step adds to the speed of the fall.
    EXPECT_NEAR(rises, restitution * restitution * height, 0.0075 + 0.5 * step * g * falls);
  });
}

}  // namespace
}  // namespace pneuma::sim

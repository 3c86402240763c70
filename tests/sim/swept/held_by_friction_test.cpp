// Friction that holds: what it lets slip in a step is made up for in the next.
#include <gtest/gtest.h>

#include "sim/inspect/checkpoint.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

constexpr double g = 9.81;  // m/s^2

Vec3 centre(const SoftBody& body) { return body.positions.rows().topRows<3>().rowwise().mean(); }

/// A crate on a torus, both on ground that slopes by 15 degrees.
World make_crate_on_torus() {
  World world;
  world.settings.contact = ContactMethod::swept;
  world.settings.sleep_speed = 0.0;
  world.settings.steps_per_second = 240;
  world.settings.gravity = {0.26 * g, 0.0, -0.97 * g};
  world.settings.ground = ContactMaterial{0.0, 0.8};
  SoftBody torus = make_body(make_torus(2.0, 0.8, 24, 10), {0.0, 0.0, 0.9});
  torus.material.n = 0.5;
  torus.material.k = 300.0;
  torus.material.vertex_mass = 4.0 / torus.positions.size();
  torus.material.surface = {0.0, 0.8};
  world.soft = {torus};
  RigidBox crate = make_rigid({3.0, 3.0, 0.5}, {0.0, 0.0, 2.05}, 2.0);
  crate.surface = {0.0, 0.8};
  world.rigid = {crate};
  return world;
}

TEST(HeldByFriction, HoldsABoxOnASoftBody) {
  World world = make_crate_on_torus();
  ASSERT_FALSE(run(world, 6.0));
  const Vec3 crate = world.rigid[0].position, torus = centre(world.soft[0]);
  ASSERT_FALSE(run(world, 4.0));
  // While it still swings; solved for with masses alone it goes by 64 mm.
  EXPECT_LT((world.rigid[0].position - crate).norm(), 2e-3);
  EXPECT_LT((centre(world.soft[0]) - torus).norm(), 2e-3);
}

TEST(HeldByFriction, IsTheSameWithoutSleep) {
  const auto hash_with = [](double sleep_speed) {
    World world = make_crate_on_torus();
    world.settings.sleep_speed = sleep_speed;
    EXPECT_FALSE(run(world, 2.0));
    return state_hash(world);
  };
  EXPECT_EQ(hash_with(0.0), hash_with(1e-12));
}

/// A box on a table that turns (rad/s), and moves with it but for the `velocity` (m/s).
World make_box_on_table(double radius, double turn, double friction, const Vec3& velocity) {
  World world;
  world.settings.contact = ContactMethod::swept;
  world.settings.ground.reset();
  world.settings.gravity = {0.0, 0.0, -g};
  RigidBox table = make_rigid({10.0, 10.0, 0.5}, {0.0, 0.0, 0.0}, 1.0);
  table.is_kinematic = true;
  table.angular_velocity = {0.0, 0.0, turn};
  RigidBox box = make_rigid({0.5, 0.5, 0.3}, {radius, 0.0, 0.403}, 1.0);
  box.rho_g = 0.0;
  box.velocity = Vec3(0.0, turn * radius, 0.0) + velocity;
  box.angular_velocity = table.angular_velocity;
  table.surface = box.surface = {0.0, friction};
  world.rigid = {table, box};
  return world;
}

/// m, across the table, after 6 s.
double way_on_turntable(double radius, double turn, double friction) {
  World world = make_box_on_table(radius, turn, friction, Vec3::Zero());
  EXPECT_FALSE(run(world, 6.0));
  const Vec3 place = world.rigid[0].orientation.conjugate() * world.rigid[1].position;
  return (place - Vec3(radius, 0.0, place.z())).norm();
}

/// Within a step a box moves along a straight line, and what it lies on along an arc: turn^2 radius
/// h^2 / 2 outwards in each step, 100 mm in all of the first and 400 mm of the second.
TEST(HeldByFriction, HoldsABoxOnATurntable) {
  EXPECT_LT(way_on_turntable(2.0, 1.0, 0.25), 2e-3);
  EXPECT_LT(way_on_turntable(0.5, 4.0, 1.2), 5e-3);
}

/// What slid is no slip that is taken back.
TEST(HeldByFriction, ABoxThatSlidesComesToRestWithoutTurningBack) {
  World world = make_box_on_table(0.0, 0.0, 0.3, {1.0, 0.0, 0.0});
  Stepper stepper(world);
  for (int i = 0; i < 60; ++i) {
    ASSERT_FALSE(stepper.step(world));
    EXPECT_GT(world.rigid[1].velocity.x(), -1e-6) << i;
  }
  EXPECT_NEAR(world.rigid[1].velocity.x(), 0.0, 1e-6);
}

/// What the next step starts from carries the weight of the crate, along the slope and across it.
TEST(HeldByFriction, WhatHeldTheCrateIsKept) {
  World world = make_crate_on_torus();
  ASSERT_FALSE(run(world, 10.0));
  Stepper stepper(world);
  constexpr int steps = 480;  // over which it swings several times
  Vec3 on_crate = Vec3::Zero();
  for (int i = 0; i < steps; ++i) {
    ASSERT_FALSE(stepper.step(world));
    for (const FeatureImpulse& kept : world.feature_impulses) {
      if (kept.first == 1) on_crate += kept.impulse;
      if (kept.second == 1) on_crate -= kept.impulse;
    }
  }
  const Vec3 weight = steps / 240.0 * world.rigid[0].mass * world.settings.gravity;
  EXPECT_LT((on_crate + weight).norm(), 0.01 * weight.norm()) << "it still swings";
}

TEST(HeldByFriction, IsTheSameAfterAResume) {
  World world = make_crate_on_torus();
  ASSERT_FALSE(run(world, 2.0));
  ASSERT_FALSE(world.friction_slips.empty());
  ASSERT_FALSE(world.feature_impulses.empty());
  World resumed = make_crate_on_torus();
  load_state(save_state(world), resumed);
  ASSERT_FALSE(run(world, 1.0));
  ASSERT_FALSE(run(resumed, 1.0));
  EXPECT_EQ(state_hash(resumed), state_hash(world));
}

}  // namespace
}  // namespace pneuma::sim

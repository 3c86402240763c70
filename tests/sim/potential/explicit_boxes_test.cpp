// Boxes that move freely under explicit integrators, where contact is a potential.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/inspect/crossings.h"
#include "tests/sim/potential/free_box_worlds.h"
#include "tests/support/count_allocations.h"

namespace pneuma::sim {
namespace {

World spinning_box(Integrator integrator, int steps_per_second) {
  World world =
      world_of_boxes(integrator, steps_per_second, {undamped_box({1, 2, 0.5}, {0, 0, 20})});
  world.rigid[0].velocity = {1, 2, 3};
  world.rigid[0].angular_velocity = {1.5, 0.3, 1.0};
  return world;
}

/// rad, after 1 s.
double turn_error(Integrator integrator, int steps_per_second) {
  World world = spinning_box(integrator, steps_per_second);
  const RigidBox exact = spun(world.rigid[0], 1.0, 48'000);
  EXPECT_FALSE(run(world, 1.0));
  return exact.orientation.angularDistance(world.rigid[0].orientation);
}

TEST(ExplicitBoxes, TurnWithTheOrdersOfTheIntegrators) {
  const auto order = [](Integrator integrator, int rate) {
    return std::log2(turn_error(integrator, rate) / turn_error(integrator, 2 * rate));
  };
  EXPECT_NEAR(order(Integrator::rk4, 15), 4.0, 0.2);
  EXPECT_NEAR(order(Integrator::velocity_verlet, 60), 2.0, 0.1);
  // Without a torque it makes the same turns.
  EXPECT_NEAR(order(Integrator::symplectic_euler, 60), 2.0, 0.1);
}

// The turn of velocity_verlet is made of turns that keep the angular momentum, and no others.
TEST(ExplicitBoxes, KeepTheirAngularMomentum) {
  World world = spinning_box(Integrator::velocity_verlet, 60);
  const Vec3 before = spin(world.rigid[0]);
  ASSERT_FALSE(run(world, 1.0));
  EXPECT_LT((spin(world.rigid[0]) - before).norm(), 1e-13 * before.norm());
  EXPECT_NEAR(world.rigid[0].position.z(), 20.0 + 3.0 - 0.5 * 9.81, 1e-11);
}

/// A box that meets another with a corner, bounces fully and does not rub.
World meeting_boxes(Integrator integrator, int steps_per_second) {
  World world = world_of_boxes(
      integrator, steps_per_second,
      {undamped_box({1, 1, 1}, {0, 0, 0}, 2.0), undamped_box({1, 0.8, 0.6}, {0.1, 0.05, 1.45})});
  world.settings.ground.reset();
  world.settings.gravity.setZero();
  world.settings.potential.distance = 0.3;
  world.settings.potential.stiffness = 300.0;
  for (RigidBox& box : world.rigid) box.surface = {1.0, 0.0};
  world.rigid[1].orientation = turned(world.rigid[1].orientation, {0.6, 0.5, 0.0});
  world.rigid[1].velocity = {0, 0, -3.0};
  return world;
}

constexpr double until_met = 0.25;  // s

RigidBox met(Integrator integrator, int steps_per_second) {
  World world = meeting_boxes(integrator, steps_per_second);
  EXPECT_FALSE(run(world, until_met));
  return world.rigid[1];
}

TEST(ExplicitBoxes, MeetWithTheOrdersOfTheIntegrators) {
  const RigidBox exact = met(Integrator::rk4, 16'000);
  EXPECT_GT((exact.velocity - Vec3(0, 0, -3)).norm(), 1.0) << "they must have met";
  const auto error = [&](Integrator integrator, int rate) {
    const RigidBox box = met(integrator, rate);
    return (box.position - exact.position).norm() +
           box.orientation.angularDistance(exact.orientation);
  };
  const auto order = [&](Integrator integrator, int rate) {
    return std::log2(error(integrator, rate) / error(integrator, 2 * rate));
  };
  EXPECT_GT(order(Integrator::rk4, 500), 1.9);
  EXPECT_GT(order(Integrator::velocity_verlet, 2000), 1.9);
  EXPECT_GT(order(Integrator::sdirk2, 1000), 1.8);
  EXPECT_NEAR(order(Integrator::implicit_euler, 2000), 1.0, 0.15);
}

TEST(ExplicitBoxes, KeepMomentaAndEnergyWhenTheyMeet) {
  World world = meeting_boxes(Integrator::velocity_verlet, 2000);
  const auto momentum = [&] {
    Vec3 sum = Vec3::Zero();
    for (const RigidBox& box : world.rigid) sum += box.mass * box.velocity;
    return sum;
  };
  const auto angular_momentum = [&] {
    Vec3 sum = Vec3::Zero();
    for (const RigidBox& box : world.rigid) {
      sum += box.mass * box.position.cross(box.velocity) + spin(box);
    }
    return sum;
  };
  const Vec3 linear = momentum(), angular = angular_momentum();
  const double before = energy(world).total();
  ASSERT_FALSE(run(world, until_met));
  EXPECT_LT((momentum() - linear).norm(), 1e-12);
  EXPECT_LT((angular_momentum() - angular).norm(), 1e-12);
  EXPECT_NEAR(energy(world).total(), before, 1e-3 * before);  // (h / duration of the touch)^2
}

TEST(ExplicitBoxes, OfAPileNeverCross) {
  for (const Integrator integrator : {Integrator::rk4, Integrator::velocity_verlet}) {
    World world = falling_pile(integrator, 480);
    Stepper stepper(world);
    bool touched = false;
    for (int i = 0; i < 360; ++i) {
      const auto divergence = stepper.step(world);
      ASSERT_FALSE(divergence) << divergence->body << ": " << divergence->what;
      const Crossings found = crossings(world);
      ASSERT_EQ(found.between_bodies + found.within_bodies, 0) << "step " << i;
      touched |= !stepper.contacts().empty();
    }
    EXPECT_TRUE(touched);
  }
}

TEST(ExplicitBoxes, AllocateNothingOnceTheContactsHavePeaked) {
  World world = falling_pile(Integrator::rk4, 480);
  const World start = world;
  Stepper stepper(world);
  for (int i = 0; i < 360; ++i) ASSERT_FALSE(stepper.step(world));
  world = start;
  const long before = allocation_count();
  for (int i = 0; i < 360; ++i) ASSERT_FALSE(stepper.step(world));
  EXPECT_EQ(allocation_count() - before, 0);
}

}  // namespace
}  // namespace pneuma::sim

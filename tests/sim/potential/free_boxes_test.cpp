// Boxes that move freely where contact is a potential: they are rigid, and part of the equation.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/inspect/checkpoint.h"
#include "sim/inspect/crossings.h"
#include "tests/sim/potential/free_box_worlds.h"

namespace pneuma::sim {
namespace {

constexpr auto implicit_integrators =
    std::to_array<Integrator>({Integrator::implicit_euler, Integrator::sdirk2});

// The momenta and the energy of turning are exact, the fall is each integrator's, and the turning
// of the second order of the step, here 0.02 rad.
TEST(FreeBoxes, FlyAndSpinAsTheRigidEquationHasIt) {
  for (const Integrator integrator : implicit_integrators) {
    World world = world_of_boxes(integrator, 120, {undamped_box({1, 2, 0.5}, {0, 0, 20})});
    RigidBox& box = world.rigid[0];
    box.velocity = {1, 2, 3};
    box.angular_velocity = {1.5, 0.3, 1.0};
    const RigidBox start = box;
    ASSERT_FALSE(run(world, 1.0));
    const RigidBox exact = spun(start, 1.0, 12'000);
    const bool is_euler = integrator == Integrator::implicit_euler;
    EXPECT_LT(exact.orientation.angularDistance(box.orientation), 1e-3);
    // Implicit Euler falls by g h t / 2 more than g t^2 / 2; sdirk2 by nothing more.
    const double late = is_euler ? 0.5 * 9.81 / 120.0 : 0.0;
    EXPECT_NEAR(box.position.z(), 20.0 + 3.0 - 0.5 * 9.81 - late, 1e-10);
    EXPECT_NEAR(box.position.x(), 1.0, 1e-11);
    EXPECT_NEAR(box.velocity.z(), 3.0 - 9.81, 1e-11);
    EXPECT_LT((spin(box) - spin(start)).norm(), 1e-11 * spin(start).norm());
    EXPECT_NEAR(box.angular_velocity.dot(spin(box)), start.angular_velocity.dot(spin(start)),
                1e-11 * start.angular_velocity.dot(spin(start)));
  }
}

// m g on the four corners below: A kappa |f'(d / r)| = m g / 4 with the weights of its vertices.
TEST(FreeBoxes, RestWhereTheBarrierCarriesThem) {
  for (const Integrator integrator : implicit_integrators) {
    World world = world_of_boxes(integrator, 60, {make_rigid({1, 1.5, 0.8}, {0, 0, 0.55}, 3.0)});
    ASSERT_FALSE(run(world, 3.0));
    const ContactSurfaces surfaces(world);
    const double reach = surfaces[0].reach;
    double low = 0.0, high = 1.0;  // of the distance over the reach
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      const double push = -surfaces.stiffness() * barrier(middle).slope * 0.5 * surfaces[0].area;
      (push > 3.0 * 9.81 ? low : high) = middle;
    }
    const double expected = (low - 1.0) * reach + 0.4;
    EXPECT_NEAR(world.rigid[0].position.z(), expected, 1e-4 * reach);
    EXPECT_LT(world.rigid[0].velocity.norm(), 1e-5);
    EXPECT_LT(world.rigid[0].angular_velocity.norm(), 1e-5);
  }
}

// Below a plate that stands still.
TEST(FreeBoxes, AreNotPulledByWhatTheyPartFrom) {
  for (const Integrator integrator : implicit_integrators) {
    for (const double restitution : {0.0, 0.2, 1.0}) {
      World world = world_of_boxes(
          integrator, 60,
          {undamped_box({2, 2, 0.5}, {0, 0, 10}), undamped_box({1, 1, 1}, {0, 0, 9.245})});
      world.rigid[0].is_kinematic = true;
      for (RigidBox& box : world.rigid) box.surface = {restitution, 0.0};
      ASSERT_FALSE(run(world, 0.4));
      EXPECT_LT(world.rigid[1].position.z(), 9.245 - 0.5 * 9.81 * 0.4 * 0.4)
          << static_cast<int>(integrator) << ", " << restitution;
    }
  }
}

// All corners meet the ground alike.
TEST(FreeBoxes, WhatFallsFlatDoesNotTurn) {
  for (const Integrator integrator :
       {Integrator::rk4, Integrator::velocity_verlet, Integrator::sdirk2}) {
    World world = world_of_boxes(integrator, 240, {undamped_box({1, 1.5, 0.8}, {0, 0, 1.4})});
    world.rigid[0].surface = {1.0, 0.0};
    ASSERT_FALSE(run(world, 0.7));
    EXPECT_GT(world.rigid[0].velocity.z(), 1.0) << static_cast<int>(integrator);
    EXPECT_LT(world.rigid[0].angular_velocity.norm(), 1e-6) << static_cast<int>(integrator);
  }
}

TEST(FreeBoxes, SlideDownASlopeAsCoulombHasIt) {
  for (const double slope : {0.3, 0.8}) {
    World world =
        world_of_boxes(Integrator::implicit_euler, 60, {undamped_box({2, 2, 0.5}, {0, 0, 0.25})});
    world.settings.ground = ContactMaterial{0.0, 0.5};
    world.rigid[0].surface = {0.0, 0.5};
    const double angle = std::atan(slope);
    world.settings.gravity = 9.81 * Vec3(std::sin(angle), 0.0, -std::cos(angle));
    ASSERT_FALSE(run(world, 1.0));
    const double before = world.rigid[0].velocity.x();
    ASSERT_FALSE(run(world, 1.0));
    const double after = world.rigid[0].velocity.x();
    if (slope < 0.5) {
      EXPECT_LT(after, world.settings.potential.regularisation_speed);
      EXPECT_NEAR(after, before, 1e-4);
    } else {
      const double expected = 9.81 * (std::sin(angle) - 0.5 * std::cos(angle));
      EXPECT_NEAR(after - before, expected, 0.01 * expected);
    }
  }
}

/// Nothing crosses and no energy comes; `look` at each step.
template <class Look>
void expect_guarantees(World& world, int steps, const Look& look) {
  Stepper stepper(world);
  double before = energy(world).total();
  for (int i = 0; i < steps; ++i) {
    const auto divergence = stepper.step(world);
    ASSERT_FALSE(divergence) << divergence->body << ": " << divergence->what;
    const Crossings found = crossings(world);
    ASSERT_EQ(found.between_bodies + found.within_bodies, 0) << "step " << i;
    const double after = energy(world).total();
    // Rounding of the energies' terms, which are far greater than their sum.
    EXPECT_LE(after, before + 1e-9 * (std::abs(before) + 1.0)) << "step " << i;
    before = after;
    look(stepper);
  }
}

TEST(FreeBoxes, NeverCrossAndGainNoEnergy) {
  for (const Integrator integrator : implicit_integrators) {
    World world = falling_pile(integrator, 60);
    bool boxes_met = false;
    expect_guarantees(world, 90, [&](const Stepper& stepper) {
      for (const Contact& contact : stepper.contacts()) {
        boxes_met |=
            contact.first.kind == SideKind::rigid && contact.second.kind == SideKind::rigid;
      }
    });
    EXPECT_TRUE(boxes_met);
  }
}

// A hundred thousand times as heavy as what it falls on: a ball of gas is pressed flat, boxes are
// pressed together, and nothing is entered.
TEST(FreeBoxes, RestOnWhatIsFarLighter) {
  for (const bool on_ball : {true, false}) {
    World world = potential_world(Integrator::implicit_euler, 60);
    double least = 1.0;
    if (on_ball) {
      world.soft.push_back(soft_ball({0, 0, 1.02}, Vec3::Zero()));
      least = world.soft[0].material.vertex_mass * world.soft[0].positions.size();
    } else {
      world.rigid.push_back(make_rigid({2, 2, 0.5}, {0, 0, 0.3}, least));
    }
    const double bottom = on_ball ? 2.2 : 0.7;
    world.rigid.push_back(make_rigid({2, 2, 0.5}, {0, 0, bottom + 0.25}, 1e5 * least));
    expect_guarantees(world, 600, [](const Stepper&) {});
    EXPECT_LT(world.rigid.back().velocity.norm(), 1e-3);
    EXPECT_LT(world.rigid.back().angular_velocity.norm(), 1e-3);
    EXPECT_GT(world.rigid.back().position.z(), 0.25);
  }
}

// A plank that spins by more than a radian in a step strikes another.
TEST(FreeBoxes, FastTurnsCrossNothing) {
  World world = world_of_boxes(
      Integrator::implicit_euler, 60,
      {undamped_box({3, 0.1, 0.3}, {0, 0, 2}), undamped_box({0.1, 1.5, 0.2}, {1.3, -1.2, 2})});
  world.settings.gravity.setZero();
  world.rigid[0].angular_velocity = {0, 0, 90.0};
  Stepper stepper(world);
  bool touched = false;
  double before = energy(world).total();
  for (int i = 0; i < 30; ++i) {
    const auto divergence = stepper.step(world);
    ASSERT_FALSE(divergence) << divergence->what;
    EXPECT_EQ(crossings(world).between_bodies, 0) << "step " << i;
    const double after = energy(world).total();
    EXPECT_LE(after, before * (1.0 + 1e-10)) << "step " << i;
    before = after;
    touched |= !stepper.contacts().empty();
  }
  EXPECT_TRUE(touched);
}

TEST(FreeBoxes, AreTheSameForAnyThreadsAndAfterAResume) {
  for (const Integrator integrator :
       {Integrator::implicit_euler, Integrator::sdirk2, Integrator::rk4, Integrator::rk8,
        Integrator::velocity_verlet}) {
    World world = falling_pile(integrator, is_implicit(integrator) ? 60 : 480);
    const std::uint64_t expected = state_hash_after(world, 1.0, 1);
    EXPECT_EQ(state_hash_after(world, 1.0, 3), expected);
    World resumed = world;
    ASSERT_FALSE(run(world, 0.5));
    load_state(save_state(world), resumed);
    EXPECT_EQ(state_hash_after(resumed, 0.5, 1), expected);
  }
}

void expect_bounce(Integrator integrator) {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    World world = world_of_boxes(integrator, 4000, {undamped_box({1, 1, 1}, {0, 0, 0.52})});
    world.settings.gravity.setZero();
    world.settings.ground = ContactMaterial{0.0, 0.0};
    world.rigid[0].surface = {restitution, 0.0};
    world.rigid[0].velocity = {0, 0, -2.0};
    ASSERT_FALSE(run(world, 0.1));
    EXPECT_NEAR(world.rigid[0].velocity.z(), 2.0 * restitution, 0.1) << restitution;
  }
}

// Under implicit steps as long as a contact lasts restitution is not seen; in short ones it is.
TEST(FreeBoxes, BounceWithTheirRestitution) {
  expect_bounce(Integrator::sdirk2);
  expect_bounce(Integrator::rk4);
}

}  // namespace
}  // namespace pneuma::sim

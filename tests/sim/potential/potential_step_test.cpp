// Steps of whole worlds in which contact is a potential.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "sim/inspect/checkpoint.h"
#include "sim/inspect/crossings.h"
#include "sim/soft/pins.h"
#include "tests/sim/potential/potential_worlds.h"

namespace pneuma::sim {
namespace {

void expect_nothing_crosses(const World& world, int step) {
  const Crossings found = crossings(world);
  EXPECT_EQ(found.between_bodies, 0) << "step " << step;
  EXPECT_EQ(found.within_bodies, 0) << "step " << step;
}

TEST(PotentialStep, TwoBallsMeetWithoutCrossingAndWithoutGainingEnergy) {
  for (const Integrator integrator : {Integrator::implicit_euler, Integrator::sdirk2}) {
    World world = potential_world(integrator, 60);
    world.soft.push_back(soft_ball({-1.2, 0, 2}, {4, 0, 0}));
    world.soft.push_back(soft_ball({1.2, 0.2, 2}, {-4, 0, 0}));
    Stepper stepper(world);
    double before = energy(world).total();
    bool touched = false;
    for (int i = 0; i < 60; ++i) {
      const auto divergence = stepper.step(world);
      ASSERT_FALSE(divergence) << divergence->what;
      const double after = energy(world).total();
      // The minimiser's tolerance: rounding of energies of some hundred joules.
      EXPECT_LE(after, before + 1e-10 * std::abs(before)) << "step " << i;
      before = after;
      touched = touched || !stepper.contacts().empty();
      expect_nothing_crosses(world, i);
    }
    EXPECT_TRUE(touched);
  }
}

/// What a step must not add to the energy is taken from motion of those that touch against each
/// other, not from that of all, nor from a body far away.
TEST(PotentialStep, BoxesThatBounceKeepMomentum) {
  World world = potential_world(Integrator::sdirk2, 240);
  world.settings.gravity.setZero();
  world.rigid = {make_rigid(Vec3::Ones(), {-1.5, 0.6, 50.3}, 1.0),
                 make_rigid({1.0, 3.0, 1.0}, {0.0, 0.0, 50.0}, 2.0),
                 make_rigid(Vec3::Ones(), {100.0, 0.0, 50.0}, 1.0)};
  for (RigidBox& box : world.rigid) {
    box.rho_g = 0.0;
    box.surface = {1.0, 0.0};
  }
  world.rigid[0].velocity = {5.0, 0.0, 0.0};
  world.rigid[2].velocity = {0.0, 7.0, 0.0};
  const Momentum before = momentum(world);
  ASSERT_FALSE(run(world, 0.5));
  EXPECT_NEAR(world.rigid[2].velocity.y(), 7.0, 1e-7);  // the minimiser's tolerance
  ASSERT_LT(world.rigid[0].velocity.x(), 0.0) << "they have met";
  const Momentum after = momentum(world);
  const auto about_boxes = [](const Momentum& of) -> Vec3 {
    return of.angular - Vec3(0.0, 0.0, 50.0).cross(of.linear);
  };
  EXPECT_LT((after.linear - before.linear).norm(), 1e-6 * 5.0);  // the minimiser's tolerance
  EXPECT_LT((about_boxes(after) - about_boxes(before)).norm(), 1e-3 * 5.0);  // order of the step
}

/// Its moment about its own axis is a six thousandth of the others.
TEST(PotentialStep, AThinRodGoesOnSpinning) {
  for (const Integrator integrator : {Integrator::implicit_euler, Integrator::sdirk2}) {
    World world = potential_world(integrator, 60);
    world.settings.gravity.setZero();
    world.rigid = {make_rigid({0.05, 4.0, 0.05}, {0.0, 0.0, 50.0}, 2.0)};
    world.rigid[0].rho_g = 0.0;
    world.rigid[0].angular_velocity = {0.0, 10.0, 0.0};
    ASSERT_FALSE(run(world, 1.0));
    EXPECT_NEAR(world.rigid[0].angular_velocity.y(), 10.0, 1e-4);  // the minimiser's tolerance
  }
}

// Whatever is between bodies pushes both alike.
TEST(PotentialStep, ContactsKeepMomentum) {
  for (const Integrator integrator : {Integrator::rk4, Integrator::implicit_euler}) {
    World world = meeting_balls(integrator, 480);
    const Momentum before = momentum(world);
    ASSERT_FALSE(run(world, 0.3));
    const Momentum after = momentum(world);
    const double size = 42 * 0.1 * 1.0;  // kg m/s, of either ball
    // Of an implicit step the minimiser's tolerance is left, of a second-order term.
    EXPECT_LT((after.linear - before.linear).norm(), 1e-5 * size);
    if (integrator == Integrator::rk4) {
      EXPECT_LT((after.linear - before.linear).norm(), 1e-12 * size);
    }
  }
}

TEST(PotentialStep, WhatStartsOnTheGroundStaysThereWithinTheReach) {
  for (const Integrator integrator : {Integrator::implicit_euler, Integrator::sdirk2}) {
    World world = potential_world(integrator, 60);
    SoftBody box = make_body(make_box({1, 1, 1}, 3), {0, 0, 0.5});
    box.material.n = 0.0;
    box.material.k = 2000.0;
    world.soft.push_back(std::move(box));
    ASSERT_DOUBLE_EQ(bounds(world.soft[0].positions).low.z(), 0.0);
    ASSERT_FALSE(run(world, 2.0));
    const double low = bounds(world.soft[0].positions).low.z();
    const ContactSurfaces surfaces(world);
    EXPECT_LT(low, 0.0);
    EXPECT_GT(low, -0.7 * surfaces[0].reach);
  }
}

// Vertices without springs are as many bodies of their own: each gets back e times its speed.
TEST(PotentialStep, RestitutionIsThatOfTheSurfaces) {
  struct Case {
    double restitution, speed;
  };
  constexpr auto cases = std::to_array<Case>({{0.0, 4.0}, {0.5, 2.0}, {0.5, 4.0}, {1.0, 4.0}});
  for (const auto& [restitution, speed] : cases) {
    World world = potential_world(Integrator::rk4, 20'000);
    world.settings.gravity.setZero();
    world.settings.ground = ContactMaterial{0.0, 0.0};
    world.settings.potential.regularisation_speed = 0.005;
    SoftBody box = make_body(make_box({1, 1, 1}, 2), {0, 0, 0.51});
    undamp(box.material);
    box.material.k = 0.0;
    box.material.n = 0.0;
    box.material.surface = {restitution, 0.0};
    for (int v = 0; v < box.velocities.size(); ++v) box.velocities[v] = Vec3(0, 0, -speed);
    world.soft.push_back(std::move(box));
    ASSERT_FALSE(run(world, 0.1 / speed));
    for (int v = 0; v < world.soft[0].velocities.size(); ++v) {
      const Vec3 velocity = world.soft[0].velocities[v];
      const bool is_bottom = world.soft[0].mesh->rest_positions[v].z() < -0.4;
      const double expected = is_bottom ? restitution * speed : -speed;
      // What is lost while a force of the size of the push is turned on below 5 mm/s.
      EXPECT_NEAR(velocity.z(), expected, 0.02 * speed) << restitution << ", " << speed;
    }
  }
}

TEST(PotentialStep, FrictionHoldsBelowItsAngleAndSlidesAboveIt) {
  for (const double slope : {0.3, 0.8}) {
    World world = potential_world(Integrator::implicit_euler, 60);
    world.settings.ground = ContactMaterial{0.0, 0.5};
    const double angle = std::atan(slope);
    world.settings.gravity = 9.81 * Vec3(std::sin(angle), 0.0, -std::cos(angle));
    SoftBody box = make_body(make_box({1, 1, 0.5}, 3), {0, 0, 0.25});
    box.material.rho_g = 0.0;
    box.material.n = 0.0;
    box.material.k = 2000.0;
    box.material.surface = {0.0, 0.5};
    world.soft.push_back(std::move(box));
    ASSERT_FALSE(run(world, 1.0));
    const double before = mean(world.soft[0].positions).x();
    ASSERT_FALSE(run(world, 1.0));
    const double way = mean(world.soft[0].positions).x() - before;
    if (slope < 0.5) {
      EXPECT_LT(way, world.settings.potential.regularisation_speed * 1.0);
    } else {
      const double expected = 9.81 * (std::sin(angle) - 0.5 * std::cos(angle));
      EXPECT_NEAR(way, 1.5 * expected, 0.05 * expected);  // from 1 s to 2 s after a start at rest
    }
  }
}

TEST(PotentialStep, AnEmptyTorusFallsToAHeapAndNeverThroughItself) {
  World world = potential_world(Integrator::implicit_euler, 60);
  SoftBody torus = make_body(make_torus(1.5, 0.5, 10, 10), {0, 0, 0.7});
  torus.material.n = 0.0;
  torus.material.k = 20.0;
  torus.material.vertex_mass = 0.1;
  world.soft.push_back(std::move(torus));
  Stepper stepper(world);
  bool touched_itself = false;
  for (int i = 0; i < 60; ++i) {
    const auto divergence = stepper.step(world);
    ASSERT_FALSE(divergence) << divergence->what;
    expect_nothing_crosses(world, i);
    for (const Contact& contact : stepper.contacts()) {
      touched_itself |= contact.second.kind == SideKind::soft;
    }
  }
  EXPECT_TRUE(touched_itself);
  EXPECT_LT(bounds(world.soft[0].positions).high.z(), 0.6);
}

/// A ball between a static box and one that comes down on it.
World pressed_ball(Integrator integrator, int steps_per_second) {
  World world = potential_world(integrator, steps_per_second);
  world.settings.ground.reset();
  world.soft.push_back(soft_ball({0, 0, 1.1}, Vec3::Zero(), 2));
  world.rigid.push_back(make_rigid({4, 4, 1}, {0, 0, -0.5}));
  world.rigid.push_back(make_rigid({4, 4, 1}, {0, 0, 2.75}));
  for (RigidBox& box : world.rigid) box.is_kinematic = true;
  world.rigid[0].name = "floor";
  world.rigid[1].name = "press";
  world.rigid[1].velocity = {0, 0, -1.0};
  return world;
}

TEST(PotentialStep, WhatIsPressedKeepsItsVolumeAndCrossesNothing) {
  for (const Integrator integrator : {Integrator::implicit_euler, Integrator::sdirk2}) {
    World world = pressed_ball(integrator, 60);
    Stepper stepper(world);
    for (int i = 0; i < 110; ++i) {  // until 0.4 m are left of two
      const auto divergence = stepper.step(world);
      ASSERT_FALSE(divergence) << divergence->body << ": " << divergence->what;
      expect_nothing_crosses(world, i);
      ASSERT_GT(volume(world.soft[0].mesh->topology, world.soft[0].positions), 0.0);
    }
    EXPECT_NEAR(world.rigid[1].position.z(), 2.75 - 110.0 / 60.0, 1e-9);
    EXPECT_LT(bounds(world.soft[0].positions).size().z(), 0.45);
  }
}

// Two plates that meet leave no room: named, and the world is as the step found it.
TEST(PotentialStep, WhatHasNoRoomEndsAsADivergenceThatNamesIt) {
  World world = pressed_ball(Integrator::implicit_euler, 30);
  world.soft[0] = soft_ball({0, 0, 1.1}, Vec3::Zero());
  Stepper stepper(world);
  std::optional<Divergence> divergence;
  for (int i = 0; i < 80 && !divergence; ++i) {
    const World before = world;
    divergence = stepper.step(world);
    if (!divergence) continue;
    EXPECT_EQ(state_hash(world), state_hash(before));
    EXPECT_EQ(divergence->step, world.steps + 1);
    EXPECT_NE(divergence->what.find("pass through"), std::string::npos) << divergence->what;
  }
  EXPECT_TRUE(divergence);
}

TEST(PotentialStep, ExplicitStepsThatWouldCrossAreDivided) {
  for (const Integrator integrator : {Integrator::symplectic_euler, Integrator::velocity_verlet,
                                      Integrator::rk4, Integrator::rk8}) {
    World world = meeting_balls(integrator, 120);
    for (SoftBody& ball : world.soft) ball.velocities.rows() *= 15.0;
    int parts = 0;
    StepperOptions options;
    options.after_part = [&](const World&) { ++parts; };
    Stepper stepper(world, options);
    for (int i = 0; i < 20; ++i) {
      const auto divergence = stepper.step(world);
      if (divergence) {
        EXPECT_NE(divergence->body, "");
        break;
      }
      expect_nothing_crosses(world, i);
    }
    EXPECT_GT(parts, 20);
  }
}

TEST(PotentialStep, IsTheSameForAnyThreadsAndAfterAResume) {
  for (const Integrator integrator :
       {Integrator::implicit_euler, Integrator::sdirk2, Integrator::velocity_verlet}) {
    World world = meeting_balls(integrator, 240);
    const std::uint64_t expected = state_hash_after(world, 0.4, 1);
    EXPECT_EQ(state_hash_after(world, 0.4, 3), expected);
    World resumed = world;
    ASSERT_FALSE(run(world, 0.2));
    load_state(save_state(world), resumed);
    EXPECT_EQ(state_hash_after(resumed, 0.2, 1), expected);
  }
}

TEST(PotentialStep, PinnedVerticesStayAndObstaclesAreMetFromAllSides) {
  World world = potential_world(Integrator::implicit_euler, 60);
  world.settings.ground.reset();
  SoftBody obstacle = make_body(make_icosphere(0.5, 1));
  const int count = obstacle.positions.size();
  obstacle.pins = make_pins(obstacle.positions, std::vector<std::uint8_t>(at(count), 1),
                            std::vector<std::uint8_t>(at(count), 0), {});
  world.soft.push_back(obstacle);
  world.soft.push_back(soft_ball({0.1, 0, 1.6}, Vec3::Zero()));
  const VertexArray before = world.soft[0].positions;
  Stepper stepper(world);
  double lowest = 10.0;
  for (int i = 0; i < 60; ++i) {
    ASSERT_FALSE(stepper.step(world));
    expect_nothing_crosses(world, i);
    lowest = std::min(lowest, world.soft[1].positions.rows().colwise().norm().minCoeff());
  }
  EXPECT_EQ((world.soft[0].positions.rows() - before.rows()).norm(), 0.0);
  EXPECT_GT(lowest, 0.4);  // no vertex inside of it
}

}  // namespace
}  // namespace pneuma::sim

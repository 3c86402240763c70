// Bodies at rest leave the step, and wake when something comes near them (ERRATA row 71).
#include "sim/world/sleep.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/inspect/checkpoint.h"
#include "sim/inspect/inspect.h"
#include "sim/soft/pins.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

/// Two stacks of three cubes of 1 m, 10 m apart.
World make_stacks() {
  World world;
  for (const double x : {0.0, 10.0}) {
    for (int i = 0; i < 3; ++i) {
      world.rigid.push_back(make_rigid(Vec3::Ones(), {x, 0.0, 0.51 + 1.02 * i}));
    }
  }
  return world;
}

bool is_first_asleep(const World& world) {
  return is_asleep(world, 0) && is_asleep(world, 1) && is_asleep(world, 2);
}

bool is_second_asleep(const World& world) {
  return is_asleep(world, 3) && is_asleep(world, 4) && is_asleep(world, 5);
}

World make_sleeping_stacks() {
  World world = make_stacks();
  EXPECT_FALSE(run(world, 3.0));
  EXPECT_TRUE(is_first_asleep(world) && is_second_asleep(world));
  return world;
}

TEST(Sleep, StacksThatRestLeaveTheStepWhereTheyLie) {
  World world = make_sleeping_stacks();
  const World before = world;
  Stepper stepper(world);
  for (int i = 0; i < 60; ++i) ASSERT_FALSE(stepper.step(world));
  EXPECT_TRUE(stepper.contacts().empty());
  EXPECT_EQ(world.steps, before.steps + 60);
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    EXPECT_EQ(world.rigid[i].position, before.rigid[i].position);
    EXPECT_TRUE(world.rigid[i].velocity.isZero(0.0));
  }
}

/// What did not sleep would still move, by less than its speed then allows.
TEST(Sleep, EndsWhereAWorldThatNeverSleepsEnds) {
  World sleeping = make_stacks(), awake = make_stacks();
  awake.settings.sleep_speed = 0.0;
  constexpr double seconds = 10.0;
  ASSERT_FALSE(run(sleeping, seconds));
  ASSERT_FALSE(run(awake, seconds));
  EXPECT_TRUE(awake.rest.empty());
  const double bound = 0.1 * sleeping.settings.sleep_speed * seconds;
  for (std::size_t i = 0; i < sleeping.rigid.size(); ++i) {
    EXPECT_LT((sleeping.rigid[i].position - awake.rigid[i].position).norm(), bound);
  }
}

TEST(Sleep, ASoftBodySleepsWithTheBoxesOnIt) {
  World world;
  SoftBody ball = make_body(make_sphere(2.0, 8, 8), {0.0, 0.0, 2.0});
  ball.material.n = 0.5;
  ball.material.rho_g = 0.2;
  world.soft = {ball};
  world.rigid = {make_rigid({4.0, 4.0, 0.5}, {0.0, 0.0, 4.5}, 20.0)};
  ASSERT_FALSE(run(world, 20.0));
  EXPECT_TRUE(is_asleep(world, 0));
  EXPECT_EQ(world.rest[0].group, world.rest[1].group);
  EXPECT_GT(world.rigid[0].position.z(), 1.0);
}

/// Awake it would leave the edge of a facet on which it stands, and roll half a metre from 15 s on.
TEST(Sleep, ASoftBodyAloneOnTheGroundStaysWhereItHasComeToRest) {
  World world;
  SoftBody ball = make_body(make_sphere(0.5, 8, 8), {0.0, 0.0, 0.55});
  ball.material.k = 50.0;
  ball.material.n = 0.01;
  ball.material.vertex_mass = 1.0 / ball.positions.size();
  world.soft = {ball};
  ASSERT_FALSE(run(world, 10.0));
  ASSERT_TRUE(is_asleep(world, 0));
  const World before = world;
  Stepper stepper(world);
  for (int i = 0; i < 60 * 20; ++i) ASSERT_FALSE(stepper.step(world));
  EXPECT_TRUE(stepper.contacts().empty());
  EXPECT_EQ(world.steps, before.steps + 60 * 20);
  EXPECT_TRUE(world.soft[0].positions.rows() == before.soft[0].positions.rows());

  for (int v = 0; v < ball.positions.size(); ++v) world.soft[0].velocities[v] = Vec3::UnitZ();
  ASSERT_FALSE(stepper.step(world));
  EXPECT_FALSE(is_asleep(world, 0));
  EXPECT_GT(world.soft[0].positions[0].z(), before.soft[0].positions[0].z());
}

TEST(Sleep, ABoxThatFallsOnAStackWakesItAndNoOther) {
  World world = make_sleeping_stacks();
  world.rigid.push_back(make_rigid(Vec3::Ones(), {0.3, 0.0, 6.0}, 5.0));
  world.rest.push_back({});
  Stepper stepper(world);
  int woken = 0;
  for (int i = 0; i < 60 && woken == 0; ++i) {
    ASSERT_FALSE(stepper.step(world));
    if (!is_first_asleep(world)) woken = i;
  }
  EXPECT_GT(woken, 30) << "it falls 2.5 m first";
  EXPECT_FALSE(is_asleep(world, 0) || is_asleep(world, 1) || is_asleep(world, 2));
  EXPECT_TRUE(is_second_asleep(world));
  EXPECT_NEAR(world.rigid.back().position.z(), 3.5, 0.2);
}

/// The impulse must be that on boxes that never slept: exactly, as the positions are the same.
TEST(Sleep, WakesIntoTheSameImpact) {
  World sleeping = make_sleeping_stacks();
  sleeping.rigid.push_back(make_rigid(Vec3::Ones(), {0.3, 0.0, 3.7}, 5.0));
  sleeping.rigid.back().velocity = {0.0, 0.0, -8.0};
  sleeping.rest.push_back({});
  World awake = sleeping;
  awake.rest.clear();
  ASSERT_FALSE(run(sleeping, 0.1));
  ASSERT_FALSE(run(awake, 0.1));
  ASSERT_FALSE(is_asleep(sleeping, 0));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(sleeping.rigid[i].position, awake.rigid[i].position) << i;
    EXPECT_EQ(sleeping.rigid[i].velocity, awake.rigid[i].velocity) << i;
  }
}

TEST(Sleep, AWorldOfFewerBoxesKnowsNothingOfTheOthers) {
  for (const double sleep_speed : {0.0, 0.01}) {
    World world = make_stacks();
    world.settings.sleep_speed = sleep_speed;
    ASSERT_FALSE(run(world, 0.25));
    ASSERT_FALSE(world.warm_start_impulses.empty());
    world.rigid.resize(3);
    World fewer = world, knowing_nothing = world;  // copies: no room is left for others
    knowing_nothing.warm_start_impulses.clear();
    knowing_nothing.rest.clear();
    ASSERT_FALSE(run(fewer, 0.1));
    ASSERT_FALSE(run(knowing_nothing, 0.1));
    EXPECT_EQ(state_hash(fewer), state_hash(knowing_nothing)) << sleep_speed;
  }
}

/// Three balls, one on the other in a shaft of four static walls.
World make_shaft() {
  World world;
  world.settings.contact = ContactMethod::swept;
  world.settings.steps_per_second = 240;
  for (const auto& [size, position] : {std::pair<Vec3, Vec3>{{0.1, 0.8, 3.0}, {-0.33, 0.0, 1.5}},
                                       {{0.1, 0.8, 3.0}, {0.33, 0.0, 1.5}},
                                       {{0.55, 0.1, 3.0}, {0.0, -0.33, 1.5}},
                                       {{0.55, 0.1, 3.0}, {0.0, 0.33, 1.5}}}) {
    world.rigid.push_back(make_rigid(size, position));
    world.rigid.back().is_kinematic = true;
  }
  for (int i = 0; i < 3; ++i) {
    SoftBody ball = make_body(make_icosphere(0.25, 1), {0.01, 0.005, 0.27 + 0.53 * i});
    ball.material.k = 60.0;
    ball.material.n = 0.001;
    ball.material.vertex_mass = 0.05 / ball.positions.size();
    ball.material.surface = {0.0, 0.1};
    world.soft.push_back(ball);
  }
  return world;
}

/// Their contacts change from step to step, so that they tremble where they lie.
TEST(Sleep, BallsThatContactsShakeFallAsleep) {
  World world = make_shaft();
  ASSERT_FALSE(run(world, 12.0));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(is_asleep(world, i)) << i;
}

/// All of it is held but the last vertex, which swings by more than what rests may move.
TEST(Sleep, ABallOfWhichOneVertexSwingsStaysAwake) {
  for (const double swing : {0.0, 0.1}) {
    World world;
    world.settings.contact = ContactMethod::swept;
    SoftBody ball = make_body(make_icosphere(1.0, 2), {0.0, 0.0, 1.0});
    ball.material.rho_g = swing > 0.0 ? 0.0 : 0.3;
    const int last = ball.positions.size() - 1;
    std::vector<std::uint8_t> is_pinned(at(last + 1), 1), follows(at(last + 1), 0);
    is_pinned[at(last)] = 0;
    ball.pins = make_pins(ball.positions, is_pinned, follows, {});
    ball.positions[last] += swing * (ball.positions[last] - mean(ball.positions));
    world.soft = {ball};
    world.rigid = {make_rigid(Vec3::Ones(), {0.0, 0.0, 2.51})};
    ASSERT_FALSE(run(world, 5.0));
    EXPECT_EQ(is_asleep(world, 0), swing == 0.0);
  }
}

/// Its middle stays, and so does its outline.
TEST(Sleep, ABallThatSpinsStaysAwake) {
  World world;
  world.settings.contact = ContactMethod::swept;
  world.settings.ground = ContactMaterial{0.0, 0.0};
  SoftBody ball = make_body(make_icosphere(1.0, 2), {0.0, 0.0, 1.0});
  ball.material.k = 200.0;
  ball.material.n = 0.05;
  ball.material.rho_g = 0.0;
  ball.material.surface = {0.0, 0.0};
  for (int v = 0; v < ball.positions.size(); ++v) {
    ball.velocities[v] = Vec3(-0.05 * ball.positions[v].y(), 0.05 * ball.positions[v].x(), 0.0);
  }
  world.soft = {ball};
  world.rigid = {make_rigid(Vec3::Ones(), {4.0, 0.0, 0.51})};
  ASSERT_FALSE(run(world, 20.0));
  EXPECT_TRUE(is_asleep(world, 1));
  EXPECT_FALSE(is_asleep(world, 0));
}

/// Slow for a box of a metre, but its own length in each second.
TEST(Sleep, ASmallBoxSlidesOn) {
  constexpr double speed = 5e-3;
  World world = make_free_boxes({make_rigid(Vec3::Constant(5e-3), {0.0, 0.0, 2.5e-3})}, 0.0);
  world.settings.contact = ContactMethod::swept;
  world.settings.gravity = {0.0, 0.0, -9.81};
  world.settings.ground = ContactMaterial{0.0, 0.0};
  world.rigid[0].velocity.x() = speed;
  ASSERT_FALSE(run(world, 3.0));
  EXPECT_NEAR(world.rigid[0].position.x(), 3.0 * speed, 1e-3 * speed);
}

TEST(Sleep, ASoftBodyWakesWhatItFallsOn) {
  World world = make_stacks();
  SoftBody ball = make_body(make_sphere(1.0, 8, 8), {0.0, 0.0, 60.0});
  ball.material.n = 0.05;
  world.soft = {ball};
  constexpr int first = 1, second = 4;  // the lowest of each stack; the ball is body 0
  ASSERT_FALSE(run(world, 3.0));
  ASSERT_TRUE(is_asleep(world, first)) << "the ball is still in the air";
  Stepper stepper(world);
  while (is_asleep(world, first)) {
    ASSERT_LT(world.steps, 60 * 6);
    ASSERT_FALSE(stepper.step(world));
  }
  EXPECT_NEAR(bounds(world.soft[0].positions).low.z(), 3.0, 0.5);
  EXPECT_TRUE(is_asleep(world, second));
}

TEST(Sleep, APushWakesTheWholeStack) {
  World world = make_sleeping_stacks();
  world.rigid[2].velocity = {3.0, 0.0, 0.0};
  Stepper stepper(world);
  ASSERT_FALSE(stepper.step(world));
  EXPECT_FALSE(is_asleep(world, 0) || is_asleep(world, 1) || is_asleep(world, 2));
  EXPECT_TRUE(is_second_asleep(world));
  EXPECT_GT(world.rigid[2].position.x(), 0.03);
}

/// A slab carries the stack until its velocity is set: downwards faster than things fall.
TEST(Sleep, ASlabThatMovesAwayWakesWhatItCarries) {
  World world;
  world.rigid = {make_rigid({4.0, 4.0, 1.0}, {0.0, 0.0, 10.0}),
                 make_rigid(Vec3::Ones(), {0.0, 0.0, 11.01})};
  world.rigid[0].is_kinematic = true;
  ASSERT_FALSE(run(world, 3.0));
  ASSERT_TRUE(is_asleep(world, 1));
  EXPECT_FALSE(is_asleep(world, 0));
  world.rigid[0].velocity = {0.0, 0.0, -20.0};
  World awake = world;
  awake.rest.clear();
  ASSERT_FALSE(run(world, 0.2));
  ASSERT_FALSE(run(awake, 0.2));
  EXPECT_FALSE(is_asleep(world, 1));
  EXPECT_LT(world.rigid[1].velocity.z(), -1.5);
  EXPECT_EQ(world.rigid[1].position, awake.rigid[1].position);
  EXPECT_EQ(world.rigid[1].velocity, awake.rigid[1].velocity);
}

TEST(Sleep, WhatTouchesNothingOrGathersSpeedStaysAwake) {
  World floating = make_stacks();
  floating.settings.gravity.setZero();
  floating.settings.ground.reset();
  ASSERT_FALSE(run(floating, 2.0));
  for (int i = 0; i < 6; ++i) EXPECT_FALSE(is_asleep(floating, i));

  // 1 % above the friction that holds it: after 0.5 s it slides at 0.02 m/s.
  World slope;
  slope.settings.ground->friction = 0.5;
  slope.rigid = {make_rigid({2.0, 2.0, 0.5}, {0.0, 0.0, 0.251})};
  slope.rigid[0].surface = {0.0, 0.5};
  slope.rigid[0].rho_g = 0.0;
  const double angle = std::atan(0.5 * 1.01);
  slope.settings.gravity = 9.81 * Vec3(std::sin(angle), 0.0, -std::cos(angle));
  ASSERT_FALSE(run(slope, 2.0));
  EXPECT_FALSE(is_asleep(slope, 0));
  EXPECT_GT(slope.rigid[0].velocity.x(), 0.05);
}

/// What a step in which a body falls asleep takes of the energy beside one in which it may not.
/// Without friction it gathers speed for ever, but is slower than anything for half a second.
TEST(Sleep, WeakGravityLetsNothingSleepThatItSpeedsUp) {
  constexpr double pull = 5e-3, seconds = 10.0;
  World world = make_free_boxes({make_rigid(Vec3::Ones(), {0.0, 0.0, 0.5})}, 0.0);
  world.settings.contact = ContactMethod::swept;
  world.settings.gravity = {pull, 0.0, -2.0 * pull};
  world.settings.ground = ContactMaterial{0.0, 0.0};
  ASSERT_FALSE(run(world, seconds));
  EXPECT_FALSE(is_asleep(world, 0));
  const double expected = 0.5 * pull * seconds * seconds;
  // Of the first order in the step of 1/60 s.
  EXPECT_NEAR(world.rigid[0].position.x(), expected, 0.01 * expected);
  world.settings.gravity = {0.0, 0.0, -2.0 * pull};
  world.rigid[0].velocity.setZero();
  ASSERT_FALSE(run(world, 1.0));
  EXPECT_TRUE(is_asleep(world, 0));
}

TEST(Sleep, TheEnergyThatFallsAsleepIsWorkOfContacts) {
  World world;
  SoftBody ball = make_body(make_sphere(2.0, 8, 8), {0.0, 0.0, 2.0});
  ball.material.n = 0.5;
  ball.material.rho_g = 0.2;
  world.soft = {ball, ball};
  for (int v = 0; v < ball.positions.size(); ++v) world.soft[1].positions[v].x() += 10.0;
  World before;
  Stepper stepper(world, {.measure_work = true, .plan = {}});
  while (!is_asleep(world, 0)) {
    ASSERT_LT(world.steps, 60 * 20);
    before = world;
    ASSERT_FALSE(stepper.step(world));
  }
  const double work = stepper.contact_work();
  World awake = before;
  awake.settings.sleep_speed = 0.0;
  Stepper other(awake, {.measure_work = true, .plan = {}});
  ASSERT_FALSE(other.step(awake));
  const double kept = energy(awake).total() - energy(world).total();
  EXPECT_GT(kept, 0.0);
  EXPECT_NEAR(other.contact_work() - work, kept, 1e-9 * std::abs(energy(world).total()));
}

TEST(Sleep, IsPartOfTheSavedState) {
  for (const double seconds : {0.8, 3.0}) {
    World world = make_stacks();
    ASSERT_FALSE(run(world, seconds));
    World loaded = make_stacks();
    load_state(save_state(world), loaded);
    for (World* both : {&world, &loaded}) {
      both->rigid[5].velocity.x() += seconds < 1.0 ? 0.0 : 2.0;
      ASSERT_FALSE(run(*both, 1.0));
    }
    EXPECT_EQ(state_hash(world), state_hash(loaded)) << "after " << seconds << " s";
    EXPECT_EQ(is_first_asleep(world), is_first_asleep(loaded));
  }
}

/// Of a ball that is quiet, but not yet for long enough.
TEST(Sleep, WhereSoftBodiesWereIsPartOfTheSavedState) {
  World world = make_shaft();
  const auto is_quiet = [&] {
    return world.rest.size() > 0 && world.rest[0].quiet_steps > 20 && !is_asleep(world, 0);
  };
  Stepper stepper(world);
  while (!is_quiet()) {
    ASSERT_LT(world.steps, 240 * 12);
    ASSERT_FALSE(stepper.step(world));
  }
  World loaded = make_shaft();
  load_state(save_state(world), loaded);
  EXPECT_EQ(state_hash(world), state_hash(loaded));
  ASSERT_FALSE(run(loaded, 0.05));
  ASSERT_GT(loaded.rest[0].quiet_steps, 0) << "it stays where it was";
  ASSERT_FALSE(run(world, 0.05));
  EXPECT_EQ(state_hash(world), state_hash(loaded));
}

}  // namespace
}  // namespace pneuma::sim

// Steps that are divided, for other bodies than those that are looked at.
#include <gtest/gtest.h>

#include "tests/sim/swept/swept_worlds.h"

namespace pneuma::sim {
namespace {

constexpr double start_gap = 0.001;  // m

/// A ball without gas at rest over a slab, nearer than half of the distance that they keep.
World make_ball_over_slab() {
  World world = make_swept_world();
  world.settings.ground.reset();
  world.settings.gravity.setZero();
  world.soft.push_back(make_body(make_icosphere(1.0, 1), {0.0, 0.0, 1.0 + start_gap}));
  world.soft.back().material.n = 0.0;
  world.rigid.push_back(make_rigid({4.0, 4.0, 1.0}, {0.0, 0.0, -0.5}, 1.0));
  world.rigid.back().is_kinematic = true;
  return world;
}

/// Far away, a cube that two others hit within a step.
void add_cube_between_two(World& world) {
  for (const double side : {0.0, 1.0, -1.0}) {
    world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {20.0 + 1.05 * side, 0.0, 0.0}, 1.0));
    world.rigid.back().velocity.x() = -10.0 * side;
    world.rigid.back().surface.restitution = 1.0;
  }
}

struct GapAfterStep {
  double grown = 0.0;  // m
  int parts = 0;       // of the step
};

/// `given_parts`: into which a run divides it.
GapAfterStep gap_after_step(World world, int given_parts = 1) {
  GapAfterStep after;
  StepperOptions options;
  options.parts = given_parts;
  options.after_part = [&](const World&) { ++after.parts; };
  world.settings.steps_per_second *= given_parts;
  Stepper stepper(world, options);
  for (int i = 0; i < given_parts; ++i) EXPECT_FALSE(stepper.step(world));
  after.grown = world.soft.front().positions.rows().row(2).minCoeff() - start_gap;
  return after;
}

/// A fifth of what is missing by degrees is up to a tenth of that less than at once.
constexpr double by_degrees = 0.1;

TEST(DividedSteps, PartWhatIsTooNearNoFasterThanWholeOnes) {
  World world = make_ball_over_slab();
  const GapAfterStep whole = gap_after_step(world);
  ASSERT_EQ(whole.parts, 1);
  add_cube_between_two(world);
  const GapAfterStep divided = gap_after_step(world);
  ASSERT_GT(divided.parts, 1);
  EXPECT_NEAR(divided.grown, whole.grown, by_degrees * whole.grown);
}

TEST(DividedSteps, OfARunDoTheSame) {
  const World world = make_ball_over_slab();
  const double whole = gap_after_step(world).grown;
  EXPECT_NEAR(gap_after_step(world, 4).grown, whole, by_degrees * whole);
}

}  // namespace
}  // namespace pneuma::sim

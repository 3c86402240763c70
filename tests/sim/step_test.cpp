#include <gtest/gtest.h>

#include "sim/inspect/checkpoint.h"
#include "sim/inspect/inspect.h"
#include "tests/support/count_allocations.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

World one_sphere() {
  World world;
  world.soft.push_back(make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, 4.0}));
  return world;
}

World many_spheres(int count) {
  World world;
  for (int i = 0; i < count; ++i) {
    world.soft.push_back(make_body(make_sphere(3.0, 8, 8), {20.0 * i, 0.0, 4.0}));
    perturb(world.soft.back(), 0.01, static_cast<unsigned>(i));
  }
  return world;
}

TEST(Plan, OneSoftBodyOnTheGroundNeedsNoPairsAndNoRigidStage) {
  const Plan plan = make_plan(one_sphere());
  EXPECT_EQ(left_out(plan), (std::vector<std::string>{
                                "integrate_rigid", "broad_phase", "move_particles", "depenetrate",
                                "rigid_ground", "soft_soft", "soft_rigid", "rigid_rigid"}));
  for (const Plan::Item& item : plan.stages) EXPECT_EQ(item.runs, item.reason.empty());
  for (const Plan::Item& item : plan.contact_kinds) EXPECT_EQ(item.runs, item.reason.empty());
}

TEST(Plan, WithoutAGroundOneBodyTouchesNothing) {
  World world = one_sphere();
  world.settings.ground.reset();
  const Plan plan = make_plan(world);
  EXPECT_FALSE(plan.runs(Stage::find_contacts));
  EXPECT_FALSE(plan.runs(Stage::resolve_contacts));
  EXPECT_TRUE(plan.runs(Stage::integrate_soft));
}

TEST(Step, LeavingOutWhatASceneDoesNotNeedChangesNoBit) {
  for (const bool ground : {true, false}) {
    World lean = one_sphere();
    if (!ground) lean.settings.ground.reset();
    World full = lean;
    ASSERT_FALSE(run(lean, 3.0));
    StepperOptions everything;
    everything.plan = make_full_plan();
    ASSERT_FALSE(run(full, 3.0, everything));
    EXPECT_EQ(state_hash(lean), state_hash(full));
  }
}

TEST(Step, ThreadsChangeNoBit) {
  World one = many_spheres(7);
  ASSERT_FALSE(run(one, 2.0));
  for (const int threads : {2, 3, 8}) {
    World several = many_spheres(7);
    StepperOptions options;
    options.threads = threads;
    ASSERT_FALSE(run(several, 2.0, options));
    EXPECT_EQ(state_hash(several), state_hash(one)) << threads;
  }
}

TEST(Step, ContinuesBitForBitFromACheckpoint) {
  for (const auto integrator : {Integrator::martin, Integrator::symplectic_euler,
                                Integrator::velocity_verlet, Integrator::rk4}) {
    World whole = one_sphere();
    whole.settings.integrator = integrator;
    World first_half = whole, second_half = whole;
    ASSERT_FALSE(run(whole, 2.0));
    ASSERT_FALSE(run(first_half, 1.0));
    load_state(save_state(first_half), second_half);
    ASSERT_FALSE(run(second_half, 1.0));
    EXPECT_EQ(state_hash(second_half), state_hash(whole));
  }
}

TEST(Step, AllocatesNothingOnceWarm) {
  const long at_start = allocation_count();
  ASSERT_GT(VertexArray(100).size() + allocation_count() - at_start, 100) << "the count must work";
  for (const auto integrator : {Integrator::martin, Integrator::symplectic_euler,
                                Integrator::velocity_verlet, Integrator::rk4}) {
    World world = one_sphere();
    world.settings.integrator = integrator;
    Stepper stepper(world);
    for (int i = 0; i < 300; ++i) ASSERT_FALSE(stepper.step(world));
    const long before = allocation_count();
    for (int i = 0; i < 300; ++i) ASSERT_FALSE(stepper.step(world));
    EXPECT_EQ(allocation_count() - before, 0);
  }
}

TEST(Step, DivergenceIsReportedInTheStepInWhichItHappens) {
  World world = one_sphere();
  world.soft[0].name = "ball";
  world.soft[0].material.k = 1e7;
  world.soft[0].material.k_max = 1e300;
  Stepper stepper(world);
  std::optional<Divergence> divergence;
  World before = world;
  for (int i = 0; i < 600 && !divergence; ++i) {
    before = world;
    divergence = stepper.step(world);
  }
  ASSERT_TRUE(divergence);
  EXPECT_EQ(divergence->body, "ball");
  EXPECT_EQ(divergence->stage, Stage::integrate_soft);
  EXPECT_EQ(divergence->step, before.steps + 1);
  EXPECT_GT(volume(before.soft[0].mesh->topology, before.soft[0].positions), 0.0);
  EXPECT_EQ(state_hash(world), state_hash(before)) << "the last sound state";
}

TEST(Step, AnEmptyMembraneMayTurnInsideOut) {
  World world = one_sphere();
  world.soft[0].material.n = 0.0;
  for (int v = 0; v < world.soft[0].positions.size(); ++v) {
    world.soft[0].positions[v].x() *= -1.0;  // mirrored: the volume is negative
  }
  EXPECT_FALSE(run(world, 5.0));
}

TEST(Step, ProfilesTheStagesThatRun) {
  World world = one_sphere();
  StepperOptions options;
  options.profile = true;
  Stepper stepper(world, options);
  for (int i = 0; i < 100; ++i) ASSERT_FALSE(stepper.step(world));
  EXPECT_GT(stepper.stage_times()[static_cast<std::size_t>(Stage::integrate_soft)], 0.0);
  EXPECT_EQ(stepper.stage_times()[static_cast<std::size_t>(Stage::integrate_rigid)], 0.0);
}

}  // namespace
}  // namespace pneuma::sim

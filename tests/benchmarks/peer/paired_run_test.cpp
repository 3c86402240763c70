#include "benchmarks/peer/paired_run.h"

#include <gtest/gtest.h>

#include "benchmarks/peer/equal_quality.h"
#include "support/worlds.h"

namespace pneuma::benchmarks {
namespace {

TEST(PairedRun, StepsBothSidesAndCountsWhatTheyDid) {
  sim::World world;
  world.soft.push_back(sim::make_body(sim::make_sphere(3.0, 8, 8), {0.0, 0.0, 3.2}));
  world.soft[0].material.n = 1.0;
  const BulletOptions setting{.position_iterations = 2, .gas_fraction = 0.05};
  const PairedRun run = run_paired("sphere", world, setting, {.seconds = 2.0, .repeats = 2});
  EXPECT_EQ(run.name, "sphere");
  EXPECT_EQ(run.bullet_options, setting);
  for (const SideResult& side : {run.bullet, run.rk4, run.velocity_verlet}) {
    EXPECT_GT(side.frame_seconds(), 1e-7);  // 58 vertices: no processor is as fast
    EXPECT_LT(side.frame_seconds(), 1e-2);
    EXPECT_GT(side.contacts_per_step, 0.5);  // on the ground most of the time
    EXPECT_GT(side.quality.inflation, 0.5);
    EXPECT_LT(side.quality.inflation, 10.0);
    EXPECT_GT(side.quality.end_speed, 0.0);
    EXPECT_LT(side.quality.end_speed, 5.0);  // dropped from 0.2 m, after 2 s
  }
}

TEST(PairedRun, OursTakesMoreStepsWhereItDiverges) {
  sim::World world = sim::make_free_world(sim::make_body(sim::make_sphere(3.0, 8, 8)));
  world.soft[0].material.n = 1.0;
  world.soft[0].material.k = 1200.0;   // rk4 bears 1,720 N/m at 1/60 s, velocity_verlet 673
  world.soft[0].material.k_max = 1e6;  // without dashpots to speak of
  const PairedRun run = run_paired("stiff", world, {}, {.seconds = 1.0, .repeats = 1});
  EXPECT_EQ(run.rk4.steps_per_second, 60);
  EXPECT_EQ(run.velocity_verlet.steps_per_second, 120);
}

TEST(LeastRate, IsTheFirstGoodOneOfFour) {
  for (const int needed : {60, 61, 200, 10'000}) {
    const int expected = needed == 60 ? 60 : needed == 61 ? 120 : needed == 200 ? 240 : 480;
    EXPECT_EQ(least_rate(60, [&](int rate) { return rate >= needed; }), expected) << needed;
  }
}

TEST(CheapestGood, IsTheCheapestOfThoseWithinTenPercent) {
  const std::vector<QualityTry> tries = {
      {"bad", 1.0, 0.2}, {"dear", 3.0, 0.01}, {"good", 2.0, 0.09}};
  ASSERT_NE(cheapest_good(tries), nullptr);
  EXPECT_EQ(cheapest_good(tries)->setting, "good");
  EXPECT_EQ(cheapest_good({{"bad", 1.0, 0.2}}), nullptr);
}

}  // namespace
}  // namespace pneuma::benchmarks

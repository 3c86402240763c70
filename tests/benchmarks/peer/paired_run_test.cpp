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
  const PairedRun run = run_paired("sphere", world, {.seconds = 2.0, .repeats = 2});
  EXPECT_EQ(run.name, "sphere");
  for (const SideResult& side : {run.bullet, run.rk4, run.velocity_verlet}) {
    EXPECT_GT(side.frame_seconds(), 1e-7);  // 58 vertices: no processor is as fast
    EXPECT_LT(side.frame_seconds(), 1e-2);
    EXPECT_GT(side.contacts_per_step, 0.5);  // on the ground most of the time
    EXPECT_GT(side.volume_ratio, 0.5);
    EXPECT_LT(side.volume_ratio, 10.0);
    EXPECT_GT(side.end_speed, 0.0);
    EXPECT_LT(side.end_speed, 5.0);  // dropped from 0.2 m, after 2 s
  }
}

TEST(SoftVolume, IsTheSumOverTheBodies) {
  sim::World world = sim::make_free_world(sim::make_body(sim::make_box({1.0, 2.0, 3.0}, 1)));
  world.soft.push_back(sim::make_body(sim::make_box({2.0, 2.0, 2.0}, 1)));
  EXPECT_NEAR(soft_volume(world), 14.0, 1e-13);  // rounding
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

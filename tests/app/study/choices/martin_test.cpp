#include "app/study/choices/martin.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/study/error/conclusions.h"
#include "tests/app/study/error/small_study.h"
#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

TEST(CompareMartin, TakesTheStepsThatAreStableForBoth) {
  ErrorStudy study = made_up_study();
  study.runs = {made_up_unstable_run("martin", 15), made_up_run("martin", 60, 0.4, 4e-4),
                made_up_run("rk4", 15, 0.1, 1e-4), made_up_run("rk4", 60, 2e-4, 5e-4),
                made_up_peer_run(1e-2, 1e-2, 1e-3, 100.0)};
  const auto comparisons = compare_martin(study);
  ASSERT_EQ(comparisons.size(), 1u);
  EXPECT_EQ(comparisons[0].other, "rk4");
  EXPECT_EQ(comparisons[0].steps_per_second, 60);
  EXPECT_NEAR(comparisons[0].error_ratio, 2000.0, 1e-9);
  EXPECT_NEAR(comparisons[0].time_ratio, 0.8, 1e-12);
}

TEST(MartinSentences, SayTheRatiosAndWhatAnErrorTakes) {
  ErrorStudy study = made_up_study();
  study.runs = {made_up_run("martin", 60, 0.4, 4e-4), made_up_run("martin", 1920, 8e-3, 12e-3),
                made_up_run("rk4", 60, 2e-4, 4e-4)};
  const auto sentences = martin_sentences(study);
  ASSERT_EQ(sentences.size(), 2u);
  EXPECT_EQ(sentences[0],
            "at 1/60 s the error of martin is 2,000 times that of rk4, at 1 times its run time");
  EXPECT_EQ(sentences[1],
            "an error of 1e-2 takes martin a step of 1/1920 s and 12,000 us per simulated second; "
            "rk4 does with 1/60 s and 400 us, 30 times as fast");
  study.runs.erase(study.runs.begin() + 1);
  EXPECT_EQ(martin_sentences(study)[1],
            "an error of 1e-2 martin reaches at none of the steps studied");
}

TEST(CompareMartin, FindsItWorseThanAllOthersAtEveryStep) {
  ErrorOptions options = short_sweep();
  options.steps_per_second = {60, 120};
  options.tolerances.clear();
  options.repeats = 1;
  const ErrorStudy study = study_errors(small_scene(), options, [](const std::string&) {});

  // At the end of the same time, by plain runs against rk4 at 1/7680 s.
  const auto positions = [](sim::Integrator integrator, int rate) {
    sim::World world = small_world();
    world.settings.integrator = integrator;
    world.settings.steps_per_second = rate;
    EXPECT_FALSE(sim::run(world, 0.4));
    return world.soft[0].positions;
  };
  const auto exact = positions(sim::Integrator::rk4, 7680);
  const auto error = [&](sim::Integrator integrator, int rate) {
    return (positions(integrator, rate).rows() - exact.rows()).norm();
  };
  std::size_t explicit_ones = 0;
  for (const MartinComparison& comparison : compare_martin(study)) {
    const int rate = comparison.steps_per_second;
    const auto other = comparison.other == "symplectic_euler"  ? sim::Integrator::symplectic_euler
                       : comparison.other == "velocity_verlet" ? sim::Integrator::velocity_verlet
                                                               : sim::Integrator::rk4;
    if (other == sim::Integrator::rk4 && comparison.other != "rk4") continue;
    ++explicit_ones;
    EXPECT_GT(comparison.error_ratio, 1.0) << comparison.other;
    EXPECT_GT(error(sim::Integrator::martin, rate), error(other, rate)) << comparison.other;
  }
  EXPECT_EQ(explicit_ones, 6u);
}

}  // namespace
}  // namespace pneuma::app

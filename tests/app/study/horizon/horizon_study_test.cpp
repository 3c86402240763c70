#include "app/study/horizon/horizon_study.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

Horizon horizon_of(const std::string& toml, const HorizonOptions& options) {
  return study_horizon(scenes::parse_scene(toml, "horizon.toml"), options,
                       [](const std::string&) {});
}

std::vector<Difference> exponential(double rate, double start, int count) {
  std::vector<Difference> differences;
  for (int i = 1; i <= count; ++i) {
    const double time = i / 15.0;
    differences.push_back({time, start * std::exp(rate * time)});
  }
  return differences;
}

TEST(Horizon, FitsTheRateOfAnExponential) {
  EXPECT_NEAR(fit_growth(exponential(1.3, 1e-9, 60)), 1.3, 1e-12);
  EXPECT_NEAR(fit_growth(exponential(-0.4, 1e-9, 60)), -0.4, 1e-12);
  EXPECT_TRUE(std::isnan(fit_growth(exponential(1.3, 1e-9, 2))));
}

TEST(Horizon, LeavesOutWhatHasGrownLarge) {
  std::vector<Difference> differences = exponential(2.0, 1e-6, 30);
  differences.push_back({2.1, 0.5});
  differences.push_back({2.2, 0.5});
  EXPECT_NEAR(fit_growth(differences), 2.0, 1e-12);
}

TEST(Horizon, TellsWhenADifferenceIsFirstAboveASize) {
  Horizon horizon;
  horizon.differences = {{0.1, 1e-9}, {0.2, 2e-6}, {0.3, 1e-7}, {0.4, 1e-3}};
  EXPECT_EQ(horizon.exceeds(1e-6), 0.2);
  EXPECT_EQ(horizon.exceeds(1e-2), std::nullopt);
}

// Without any force every vertex keeps its own distance.
TEST(Horizon, WhereNothingActsADifferenceStaysAsItIs) {
  const Horizon horizon = horizon_of(
      "duration = 1.0\n[simulation]\ngravity = [0, 0, 0]\n[ground]\npresent = false\n[[body]]\n"
      "k = 0.0\nn = 0.0\nrho_g = 0.0\n[[body]]\nkind = \"rigid\"\nsize = [1, 1, 1]\nposition = "
      "[9, 0, 0]\n",
      {.difference = 1e-6, .tries = 3, .seconds = {}});
  // 58 vertices of three random components each: of their sum of squares 1 / sqrt(87) is chance.
  EXPECT_NEAR(horizon.differences.front().size, 1e-6, 0.4e-6);
  EXPECT_NEAR(horizon.differences.back().size, horizon.differences.front().size, 1e-12);
  EXPECT_NEAR(horizon.growth_rate, 0.0, 1e-6);
}

// A box that spins about the middle one of its axes, of which a difference grows as
// exp(w sqrt((a - b) (b - c) / (a c)) t), with moments of inertia a > b > c and the spin w about
// b's (Euler's equations, linearised).
TEST(Horizon, GrowsAsABoxTumbles) {
  const Horizon horizon = horizon_of(
      "duration = 6.0\n[simulation]\ngravity = [0, 0, 0]\nsteps_per_second = 960\n[ground]\n"
      "present = false\n[[body]]\nkind = \"rigid\"\nsize = [1, 2, 3]\nposition = [0, 0, 9]\n"
      "angular_velocity = [0, 5, 0]\nrho_g = 0.0\n",
      {.difference = 1e-9, .tries = 3, .seconds = {}});
  // 5 %: at first what shrinks as fast is as large, and boxes turn with an error of the step's
  // order.
  EXPECT_NEAR(horizon.growth_rate, 5.0 * std::sqrt(3.0 * 5.0 / (13.0 * 5.0)), 0.05 * 2.4);
}

}  // namespace
}  // namespace pneuma::app

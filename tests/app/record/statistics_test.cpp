#include "app/record/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pneuma::app {
namespace {

/// The value of a rank, found by counting instead of sorting: the one with at most `rank` values
/// below it and more than `rank` not above it.
double of_rank(const std::vector<double>& values, std::size_t rank) {
  for (const double candidate : values) {
    std::size_t below = 0, not_above = 0;
    for (const double value : values) {
      below += value < candidate ? 1 : 0;
      not_above += value <= candidate ? 1 : 0;
    }
    if (below <= rank && rank < not_above) return candidate;
  }
  return std::nan("");
}

double brute_force(const std::vector<double>& values, double percent) {
  const double position = percent / 100.0 * static_cast<double>(values.size() - 1);
  const double below = std::floor(position), above = std::ceil(position);
  const double a = of_rank(values, static_cast<std::size_t>(below));
  const double b = of_rank(values, static_cast<std::size_t>(above));
  return a * (1.0 - (position - below)) + b * (position - below);
}

TEST(Statistics, SpreadEqualsCountingOnRandomSamplesWithTies) {
  std::mt19937_64 random(1);
  for (std::size_t size = 1; size <= 60; ++size) {
    std::uniform_int_distribution<int> integers(0, 20);  // few, so that values repeat
    std::vector<double> values(size);
    for (double& value : values) value = 0.25 * integers(random);
    const Spread result = spread(values);
    // Both interpolate in doubles, in a different order of operations.
    EXPECT_NEAR(result.low, brute_force(values, 5.0), 1e-12) << size;
    EXPECT_NEAR(result.median, brute_force(values, 50.0), 1e-12) << size;
    EXPECT_NEAR(result.high, brute_force(values, 95.0), 1e-12) << size;
  }
}

TEST(Statistics, EndsAreLeastAndGreatest) {
  const std::vector<double> sorted = {-3.0, 1.0, 1.0, 7.5};
  EXPECT_EQ(percentile(sorted, 0.0), -3.0);
  EXPECT_EQ(percentile(sorted, 100.0), 7.5);
  EXPECT_EQ(percentile(std::vector<double>{4.0}, 95.0), 4.0);
}

TEST(Statistics, MedianOfAnEvenCountIsTheMiddleOfTheMiddleTwo) {
  EXPECT_EQ(spread({10.0, 1.0, 4.0, 2.0}).median, 3.0);
}

TEST(Statistics, InverseOfASpreadIsTheSpreadOfInverses) {
  // 21 values, so that the 5th and 95th percentiles are values themselves: between two values,
  // interpolating and inverting do not commute.
  std::vector<double> times, rates;
  for (int i = 1; i <= 21; ++i) {
    times.push_back(0.5 * i);
    rates.push_back(1.0 / (0.5 * i));
  }
  const Spread inverted = inverse(spread(times)), direct = spread(rates);
  EXPECT_DOUBLE_EQ(inverted.low, direct.low);
  EXPECT_DOUBLE_EQ(inverted.median, direct.median);
  EXPECT_DOUBLE_EQ(inverted.high, direct.high);
  EXPECT_LT(inverted.low, inverted.high);
}

TEST(Statistics, RefusesWhatHasNoPercentile) {
  EXPECT_THROW(percentile({}, 50.0), std::invalid_argument);
  EXPECT_THROW(percentile(std::vector<double>{1.0}, -1.0), std::invalid_argument);
  EXPECT_THROW(percentile(std::vector<double>{1.0}, 100.5), std::invalid_argument);
  EXPECT_THROW(percentile(std::vector<double>{1.0}, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace pneuma::app

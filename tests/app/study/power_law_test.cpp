#include "app/study/power_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace pneuma::app {
namespace {

TEST(PowerLaw, IsFoundAgain) {
  const std::vector<double> x = {0.1, 0.5, 2.0, 30.0};
  std::vector<double> y;
  for (const double value : x) y.push_back(0.7 * std::pow(value, -1.5));
  const PowerLaw law = fit_power_law(x, y);
  EXPECT_NEAR(law.exponent, -1.5, 1e-14);  // rounding
  EXPECT_NEAR(law.factor, 0.7, 1e-14);
}

TEST(PowerLaw, IsTheLineOfLeastSquaresThroughTheLogarithms) {
  // ln x = 0, 1, 2 and ln y = 0, 2, 1: by hand, slope 1/2 and mean 1 at ln x = 1.
  const double e = std::exp(1.0);
  const PowerLaw law = fit_power_law(std::vector{1.0, e, e * e}, std::vector{1.0, e * e, e});
  EXPECT_NEAR(law.exponent, 0.5, 1e-14);
  EXPECT_NEAR(law.factor, std::exp(0.5), 1e-14);
}

TEST(PowerLaw, RefusesWhatHasNone) {
  using Values = std::vector<double>;
  EXPECT_THROW(fit_power_law(Values{1.0}, Values{1.0}), std::invalid_argument);
  EXPECT_THROW(fit_power_law(Values{1.0, 2.0}, Values{1.0}), std::invalid_argument);
  EXPECT_THROW(fit_power_law(Values{1.0, 2.0}, Values{1.0, 0.0}), std::invalid_argument);
  EXPECT_THROW(fit_power_law(Values{-1.0, 2.0}, Values{1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(fit_power_law(Values{3.0, 3.0}, Values{1.0, 2.0}), std::invalid_argument);
  EXPECT_THROW(fit_power_law(Values{1.0, 2.0}, Values{1.0, std::nan("")}), std::invalid_argument);
}

TEST(LocalExponents, AreOfNeighbours) {
  const auto exponents = local_exponents(std::vector{1.0, 2.0, 4.0}, std::vector{1.0, 4.0, 32.0});
  ASSERT_EQ(exponents.size(), 2u);
  EXPECT_NEAR(exponents[0], 2.0, 1e-14);
  EXPECT_NEAR(exponents[1], 3.0, 1e-14);
}

/// Points at x = 1, 1/2, 1/4, ... whose local exponents are the given ones.
struct Series {
  explicit Series(const std::vector<double>& exponents) {
    for (const double exponent : exponents) {
      x.push_back(0.5 * x.back());
      y.push_back(std::pow(0.5, exponent) * y.back());
    }
  }
  std::vector<double> x = {1.0}, y = {1.0};
};

TEST(PowerLawRange, LeavesOutWhatIsNotYetOrNoLongerAPowerLaw) {
  const Series series({7.0, 5.0, 4.1, 4.05, 4.0, 2.0, 0.1});
  const auto range = power_law_range(series.x, series.y, 0.2);
  ASSERT_TRUE(range);
  EXPECT_EQ(range->first, 2u);
  EXPECT_EQ(range->last, 5u);
  EXPECT_EQ(range->count(), 4u);
}

TEST(PowerLawRange, IsTheLastOfSeveralAsLong) {
  const Series series({1.0, 1.0, 3.0, 2.0, 2.0});
  const auto range = power_law_range(series.x, series.y, 0.1);
  ASSERT_TRUE(range);
  EXPECT_EQ(range->first, 3u);
  EXPECT_EQ(range->last, 5u);
}

TEST(PowerLawRange, DoesNotAddUpSmallChanges) {
  // Neighbours differ by less than the band, the ends by more.
  const Series series({1.0, 1.15, 1.3, 1.45});
  const auto range = power_law_range(series.x, series.y, 0.2);
  ASSERT_TRUE(range);
  EXPECT_EQ(range->count(), 3u);
  EXPECT_EQ(range->last, 4u);
}

TEST(PowerLawRange, NeedsThreePoints) {
  EXPECT_FALSE(power_law_range(std::vector<double>{}, std::vector<double>{}, 0.2));
  const Series two({1.0}), changing({1.0, 2.0, 3.0});
  EXPECT_FALSE(power_law_range(two.x, two.y, 0.2));
  EXPECT_FALSE(power_law_range(changing.x, changing.y, 0.2));
}

}  // namespace
}  // namespace pneuma::app

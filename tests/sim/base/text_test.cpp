#include "sim/base/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pneuma::base {
namespace {

TEST(Text, HasThreeDigits) {
  EXPECT_EQ(text(1234.6), "1.23e+03");
  EXPECT_EQ(text(0.39766), "0.398");
}

TEST(Text, OfLimitsStaysOnTheirSideWithinAUnitOfTheThirdDigit) {
  EXPECT_EQ(text_below(0.39766), "0.397");
  EXPECT_EQ(text_above(0.39736), "0.398");
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-12.0, 12.0);
  for (int i = 0; i < 10'000; ++i) {
    const double value = std::pow(10.0, exponent(random));
    const double below = std::stod(text_below(value)), above = std::stod(text_above(value));
    EXPECT_LE(below, value);
    EXPECT_GE(above, value);
    EXPECT_NEAR(below, value, 0.0101 * value);
    EXPECT_NEAR(above, value, 0.0101 * value);
  }
}

}  // namespace
}  // namespace pneuma::base

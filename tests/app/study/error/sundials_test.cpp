#include "app/study/error/sundials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace pneuma::app {
namespace {

/// x'' = -x from x = 1 at rest: x = cos t.
bool oscillate(double, const double* state, double* derivative) {
  derivative[0] = state[1];
  derivative[1] = -state[0];
  return true;
}

double error_after_10_s(SundialsMethod method, double tolerance) {
  Sundials solver(method, oscillate, {1.0, 0.0}, {tolerance, {tolerance, tolerance}});
  EXPECT_TRUE(solver.advance_to(3.0));
  EXPECT_TRUE(solver.advance_to(10.0));
  return std::abs(solver.state()[0] - std::cos(10.0));
}

class SundialsMethods : public testing::TestWithParam<SundialsMethod> {};
INSTANTIATE_TEST_SUITE_P(All, SundialsMethods, testing::ValuesIn(sundials_methods));

TEST_P(SundialsMethods, FollowAnOscillation) {
  // The tolerance holds for each of a few hundred steps, whose errors partly add up. Methods of
  // high order take few steps.
  EXPECT_LT(error_after_10_s(GetParam(), 1e-9), 1e-6);
  EXPECT_GT(error_after_10_s(GetParam(), 1e-3), 1e-6);
}

TEST_P(SundialsMethods, CountEvaluations) {
  long count = 0;
  Sundials solver(GetParam(),
                  [&count](double time, const double* state, double* derivative) {
                    ++count;
                    return oscillate(time, state, derivative);
                  },
                  {1.0, 0.0}, {1e-6, {1e-6, 1e-6}});
  EXPECT_TRUE(solver.advance_to(1.0));
  EXPECT_EQ(solver.evaluations(), count);
}

TEST_P(SundialsMethods, GiveUpWhereTheStateHasNoMeaning) {
  // Falls below 0.3 at t = 0.7, where there is no right-hand side.
  const auto fall = [](double, const double* state, double* derivative) {
    derivative[0] = -1.0;
    return state[0] > 0.3;
  };
  Sundials solver(GetParam(), fall, {1.0}, {1e-6, {1e-6}});
  if (GetParam() < SundialsMethod::arkode_3) {  // ARKODE's try no shorter step
    EXPECT_TRUE(solver.advance_to(0.5));
    EXPECT_NEAR(solver.state()[0], 0.5, 1e-5);  // tolerance over a few steps
  }
  EXPECT_FALSE(solver.advance_to(2.0));
}

// More numbers than the vector's sums take at once, and no multiple of that.
TEST_P(SundialsMethods, FollowManyOscillations) {
  constexpr int count = 301;
  const auto frequency = [](int i) { return 1.0 + 0.01 * i; };
  const auto oscillate_all = [&](double, const double* state, double* derivative) {
    for (int i = 0; i < count; ++i) {
      derivative[2 * i] = state[2 * i + 1];
      derivative[2 * i + 1] = -frequency(i) * frequency(i) * state[2 * i];
    }
    return true;
  };
  std::vector<double> start(2 * count);
  for (int i = 0; i < count; ++i) start[2 * static_cast<std::size_t>(i)] = 1.0;
  Sundials solver(GetParam(), oscillate_all, start,
                  {1e-8, std::vector<double>(start.size(), 1e-8)});
  EXPECT_TRUE(solver.advance_to(2.0));
  for (int i = 0; i < count; ++i) {
    EXPECT_NEAR(solver.state()[2 * static_cast<std::size_t>(i)], std::cos(2.0 * frequency(i)), 1e-5)
        << i;
  }
}

TEST(Sundials, WantsATolerancePerComponent) {
  EXPECT_THROW(Sundials(SundialsMethod::cvode_adams, oscillate, {1.0, 0.0}, {1e-6, {1e-6}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace pneuma::app

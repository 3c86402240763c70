#include "app/study/error/cvode.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace pneuma::app {
namespace {

/// x'' = -x from x = 1 at rest: x = cos t.
bool oscillate(const double* state, double* derivative) {
  derivative[0] = state[1];
  derivative[1] = -state[0];
  return true;
}

double error_after_10_s(CvodeMethod method, double tolerance) {
  Cvode solver(method, oscillate, {1.0, 0.0}, {tolerance, {tolerance, tolerance}});
  EXPECT_TRUE(solver.advance_to(3.0));
  EXPECT_TRUE(solver.advance_to(10.0));
  return std::abs(solver.state()[0] - std::cos(10.0));
}

class CvodeMethods : public testing::TestWithParam<CvodeMethod> {};
INSTANTIATE_TEST_SUITE_P(Both, CvodeMethods, testing::Values(CvodeMethod::adams, CvodeMethod::bdf));

TEST_P(CvodeMethods, FollowAnOscillation) {
  // The tolerance holds for each of a few hundred steps, whose errors partly add up.
  EXPECT_LT(error_after_10_s(GetParam(), 1e-9), 1e-6);
  EXPECT_GT(error_after_10_s(GetParam(), 1e-3), 1e-6);
}

TEST_P(CvodeMethods, CountEvaluations) {
  long count = 0;
  Cvode solver(GetParam(),
               [&count](const double* state, double* derivative) {
                 ++count;
                 return oscillate(state, derivative);
               },
               {1.0, 0.0}, {1e-6, {1e-6, 1e-6}});
  EXPECT_TRUE(solver.advance_to(1.0));
  EXPECT_EQ(solver.evaluations(), count);
}

TEST_P(CvodeMethods, GiveUpWhereTheStateHasNoMeaning) {
  // Falls below 0.3 at t = 0.7, where there is no right-hand side.
  const auto fall = [](const double* state, double* derivative) {
    derivative[0] = -1.0;
    return state[0] > 0.3;
  };
  Cvode solver(GetParam(), fall, {1.0}, {1e-6, {1e-6}});
  EXPECT_TRUE(solver.advance_to(0.5));
  EXPECT_NEAR(solver.state()[0], 0.5, 1e-5);  // tolerance over a few steps
  EXPECT_FALSE(solver.advance_to(2.0));
}

TEST(Cvode, WantsATolerancePerComponent) {
  EXPECT_THROW(Cvode(CvodeMethod::adams, oscillate, {1.0, 0.0}, {1e-6, {1e-6}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace pneuma::app

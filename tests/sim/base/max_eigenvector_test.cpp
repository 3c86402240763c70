#include "sim/base/max_eigenvector.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pneuma::base {
namespace {

// Of a matrix whose largest eigenvalue is a hundred times the next, at any scale.
TEST(MaxEigenvector, IsFoundAtAnyScale) {
  constexpr int size = 60;
  Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(size, 0.01, 1.0);
  values[17] = 100.0;
  for (const double scale : {1e-200, 1e-12, 1.0, 1e7, 1e15, 1e200, 1e300}) {
    const Eigen::VectorXd found = max_eigenvector(size, [&](const Eigen::VectorXd& u) {
      return Eigen::VectorXd(scale * values.cwiseProduct(u));
    });
    EXPECT_NEAR(std::abs(found[17]), 1.0, 1e-12) << scale;
  }
}

TEST(MaxEigenvector, OfNothingIsAnyDirection) {
  const Eigen::VectorXd found =
      max_eigenvector(5, [](const Eigen::VectorXd& u) { return Eigen::VectorXd(0.0 * u); });
  EXPECT_NEAR(found.norm(), 1.0, 1e-12);
}

}  // namespace
}  // namespace pneuma::base

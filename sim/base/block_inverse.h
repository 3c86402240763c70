// Inverses of the 3 x 3 blocks on the diagonal of a Hessian, which precondition conjugate
// gradients.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace pneuma::base {

/// Writes A^-1 = W^T W, W the inverse of A's Cholesky factor: positive definite where one direction
/// is up to 1e14 times as stiff as the others, which by cofactors would be lost in rounding from
/// 1e8 on. A is symmetric; false, and nothing is written, if it is not positive definite.
[[nodiscard]] inline bool invert_positive_definite(const Eigen::Matrix3d& a,
                                                   Eigen::Matrix3d& inverse) {
  if (!(a(0, 0) > 0.0)) return false;
  const double w00 = 1.0 / std::sqrt(a(0, 0));
  const double l10 = w00 * a(1, 0), l20 = w00 * a(2, 0);
  const double second = a(1, 1) - l10 * l10;
  if (!(second > 0.0)) return false;
  const double w11 = 1.0 / std::sqrt(second);
  const double l21 = w11 * (a(2, 1) - l20 * l10);
  const double third = a(2, 2) - l20 * l20 - l21 * l21;
  if (!(third > 0.0)) return false;
  const double w22 = 1.0 / std::sqrt(third);
  const double w10 = -w11 * l10 * w00, w21 = -w22 * l21 * w11;
  const double w20 = -w22 * (l20 * w00 + l21 * w10);
  inverse(0, 0) = w00 * w00 + w10 * w10 + w20 * w20;
  inverse(1, 1) = w11 * w11 + w21 * w21;
  inverse(2, 2) = w22 * w22;
  inverse(0, 1) = inverse(1, 0) = w10 * w11 + w20 * w21;
  inverse(0, 2) = inverse(2, 0) = w20 * w22;
  inverse(1, 2) = inverse(2, 1) = w21 * w22;
  return true;
}

}  // namespace pneuma::base

// The eigenvector of the largest eigenvalue of a symmetric operator, by Lanczos' method with all
// vectors kept orthogonal.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

namespace pneuma::base {

/// Lanczos vectors. The largest eigenvalue, at the end of a spectrum that thins out there, is then
/// known to a fraction of a percent.
inline constexpr int max_subspace = 40;

inline Eigen::VectorXd random_direction(Eigen::Index size) {
  std::mt19937_64 random(1);
  Eigen::VectorXd result(size);
  for (double& value : result) value = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
  return result.normalized();
}

/// Also where the square is beyond all numbers.
inline double norm_of(const Eigen::VectorXd& vector) {
  const double norm = vector.norm();
  return std::isfinite(norm) && norm > 0.0 ? norm : vector.stableNorm();
}

/// Of size 1, as far as so many Lanczos vectors find it from `start`, a vector of size 1. `apply`
/// takes a vector and returns the operator's product with it.
template <class Operator>
Eigen::VectorXd max_eigenvector_from(const Eigen::VectorXd& start, Eigen::Index vectors,
                                     const Operator& apply) {
  using Eigen::VectorXd;
  const Eigen::Index size = start.size(), count = std::min(size, vectors);
  Eigen::MatrixXd basis(size, count);
  VectorXd diagonal(count), off_diagonal(count);
  VectorXd next = start;
  Eigen::Index used = 0;
  while (used < count) {
    basis.col(used) = next;
    next = apply(VectorXd(basis.col(used)));
    diagonal[used] = basis.col(used).dot(next);
    ++used;
    for (int twice = 0; twice < 2; ++twice) {
      next -= basis.leftCols(used) * (basis.leftCols(used).transpose() * next);
    }
    off_diagonal[used - 1] = norm_of(next);
    if (!(off_diagonal[used - 1] > 1e-12 * std::abs(diagonal.head(used).maxCoeff()))) break;
    next /= off_diagonal[used - 1];
  }
  // Scaled: the solver takes an entry for zero whose square is small beside the diagonal, so that
  // of large numbers none ever is.
  const double scale = diagonal.head(used).cwiseAbs().maxCoeff();
  if (scale > 0.0) {
    diagonal /= scale;
    off_diagonal /= scale;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal.head(used), off_diagonal.head(used - 1));
  return basis.leftCols(used) * solver.eigenvectors().col(used - 1);
}

/// From a random start.
template <class Operator>
Eigen::VectorXd max_eigenvector(Eigen::Index size, const Operator& apply) {
  return max_eigenvector_from(random_direction(size), max_subspace, apply);
}

}  // namespace pneuma::base

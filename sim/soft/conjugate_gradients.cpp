#include "sim/soft/conjugate_gradients.h"

#include <cmath>

#include "sim/base/block_inverse.h"

namespace pneuma::sim {
namespace {

/// So many iterations take a half to a third of the time of new factors
/// (tests/benchmarks/README.md).
double max_gradient_iterations(int vertex_count) { return std::pow(vertex_count, 0.75); }

}  // namespace

ConjugateGradients::ConjugateGradients(int vertex_count)
    : inverse_(at(vertex_count)),
      residual_(vertex_count),
      preconditioned_(vertex_count),
      search_(vertex_count),
      product_(vertex_count) {}

/// The iterations grow in number as the root of H's condition, which is about twice the stiffness
/// of all springs of a vertex over its inertia. Where a motion is smooth they are fewer.
bool ConjugateGradients::promises_to_be_quick(int vertex_count, double stiffness, double inertia) {
  constexpr double mean_valence = 6.0;
  const double condition = 2.0 * mean_valence * stiffness / inertia;
  return std::sqrt(condition) < 2.0 * max_gradient_iterations(vertex_count);
}

bool ConjugateGradients::invert_diagonal(const VertexMatrix& matrix, const VertexArray& rank_one) {
  for (int v = 0; v < rank_one.size(); ++v) {
    const Vec3 q = rank_one[v];
    const Mat3 block = matrix.diagonal_block(v) + q * q.transpose();
    if (!base::invert_positive_definite(block, inverse_[at(v)])) return false;
  }
  return true;
}

void ConjugateGradients::precondition() {
  for (int v = 0; v < residual_.size(); ++v) {
    preconditioned_[v] = inverse_[at(v)] * residual_[v];
  }
}

void ConjugateGradients::multiply(const VertexMatrix& matrix, const VertexArray& rank_one) {
  matrix.multiply(search_, product_);
  product_.rows() += dot(rank_one, search_) * rank_one.rows();
}

ConjugateGradients::End ConjugateGradients::solve(const VertexMatrix& matrix,
                                                  const VertexArray& rank_one,
                                                  const VertexArray& gradient,
                                                  VertexArray& direction) {
  if (!invert_diagonal(matrix, rank_one)) return End::not_positive;
  direction.rows().setZero();
  residual_.rows() = -gradient.rows();
  precondition();
  search_.rows() = preconditioned_.rows();
  double size = dot(residual_, preconditioned_);
  const double target = forcing_term * forcing_term * size;
  const int max_iterations = static_cast<int>(max_gradient_iterations(gradient.size()));
  for (int i = 0; i < max_iterations && size > target; ++i) {
    multiply(matrix, rank_one);
    const double curvature = dot(search_, product_);
    if (!(curvature > 0.0)) return End::not_positive;
    const double length = size / curvature;
    direction.rows() += length * search_.rows();
    residual_.rows() -= length * product_.rows();
    precondition();
    const double before = size;
    size = dot(residual_, preconditioned_);
    search_.rows() = preconditioned_.rows() + size / before * search_.rows();
  }
  return size <= target ? End::solved : End::too_slow;
}

}  // namespace pneuma::sim

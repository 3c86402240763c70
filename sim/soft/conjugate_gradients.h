// Conjugate gradients for Newton's direction p = -H^-1 g, H = S + q q^T, as far as an inexact
// Newton method needs it.
//
// Where springs are not stiff beside the inertia, a vertex feels within a step only those near it,
// and some ten iterations tell the direction; each takes a small fraction of the time of sparse
// factors. The preconditioner is block Jacobi: the 3 x 3 blocks on H's diagonal.
// tests/benchmarks/README.md compares conjugate gradients with factors.
#pragma once

#include <vector>

#include "sim/soft/vertex_matrix.h"

namespace pneuma::sim {

class ConjugateGradients {
 public:
  /// Takes memory for all that follows.
  explicit ConjugateGradients(int vertex_count);

  /// The forcing term: the fraction of the residual, in the preconditioner's norm, that may be
  /// left.
  static constexpr double forcing_term = 1e-3;

  /// False where springs are so stiff that it would be too slow: a guess.
  static bool promises_to_be_quick(int vertex_count, double stiffness, double inertia);

  enum class End {
    solved,
    not_positive,  // H has been seen not to be positive definite
    too_slow,      // it has taken a good part of the time that factors take
  };

  /// `matrix` is S, `rank_one` q. Writes p, which means something only when `solved`: then H is
  /// positive along all directions that it was searched in, which it need not be along others.
  End solve(const VertexMatrix& matrix, const VertexArray& rank_one, const VertexArray& gradient,
            VertexArray& direction);

 private:
  bool invert_diagonal(const VertexMatrix& matrix, const VertexArray& rank_one);
  void precondition();
  void multiply(const VertexMatrix& matrix, const VertexArray& rank_one);

  std::vector<Mat3> inverse_;  // per vertex, of the block on the diagonal
  VertexArray residual_;
  VertexArray preconditioned_;
  VertexArray search_;   // along which p is improved next
  VertexArray product_;  // H search
};

}  // namespace pneuma::sim

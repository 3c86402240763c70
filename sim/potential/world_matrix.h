// The second derivative of the incremental potential of a whole world, as a sum of parts that can
// be multiplied and summed up, and Newton's directions by conjugate gradients.
//
// Parts: a 3 x 3 block for each vertex and each edge of a mesh, q q^T of each body's gas, and for
// contacts either 3 x 3 blocks between weighted sums of vertices or whole 12 x 12 ones. The
// preconditioner is block Jacobi.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/mesh/vec4d.h"
#include "sim/mesh/vertex_array.h"
#include "sim/potential/lagged_terms.h"

namespace pneuma::sim {

class WorldMatrix {
 public:
  /// `is_mobile`: rows and columns of other vertices are left out when it is solved for.
  explicit WorldMatrix(const std::vector<std::uint8_t>& is_mobile);

  void clear();
  void add_diagonal(int vertex, double value);
  void add(int vertex, const Mat3& block) { diagonal_[at(vertex)] += block; }
  /// In the rows of a and the columns of b, and transposed.
  void add_between(int a, int b, const Mat3& block);
  /// q q^T of the vertices from `first` on.
  void add_rank_one(int first, const VertexArray& q);
  std::vector<WeightedBlock>& blocks() { return blocks_; }
  void add_whole(const std::array<int, 4>& vertices, const Mat12& block);

  /// All of it times `values`.
  void multiply(const VertexArray& values, VertexArray& product) const;

  enum class End { solved, not_positive, too_slow };
  /// Solves H p = right for the mobile vertices, on whose rows `right` must be zero elsewhere.
  /// `shift` is added to the diagonal. Unless positive, p means nothing.
  End solve(const VertexArray& right, double shift, VertexArray& direction);

  int iterations() const { return iterations_; }  // of conjugate gradients so far

 private:
  struct Edge {
    int a, b;
    Mat3x4 block, transposed;
  };
  struct RankOne {
    int first;
    VertexArray q;
  };
  struct Whole {
    std::array<int, 4> vertices;
    Mat12 block;
  };

  bool invert_diagonal(double shift);
  void precondition();
  void clear_fixed(VertexArray& values) const;

  const std::vector<std::uint8_t>& is_mobile_;
  std::vector<Mat3> diagonal_;
  std::vector<Edge> edges_;
  std::vector<RankOne> rank_ones_;
  std::size_t rank_one_count_ = 0;
  std::vector<WeightedBlock> blocks_;
  std::vector<Whole> wholes_;
  std::vector<Mat3> whole_diagonal_;  // of all parts
  std::vector<Mat3x4> inverse_;
  VertexArray residual_, preconditioned_, search_, product_;
  int iterations_ = 0;
};

}  // namespace pneuma::sim

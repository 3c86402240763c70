// A symmetric matrix over the coordinates of a mesh's vertices, with a 3 x 3 block for every vertex
// and every edge, of hinges also for the two vertices across each edge, and its sparse factors
// L D L^T.
//
// The vertices are put in an order of little fill (approximate minimum degree) and the pattern is
// analysed once, when this is made. Up to 5,461 vertices factorize() keeps to the memory taken
// then; above, Eigen's three temporary columns outgrow the stack (EIGEN_STACK_ALLOCATION_LIMIT, 128
// KiB each) and are allocated each time.
#pragma once

#include <Eigen/SparseCholesky>
#include <array>
#include <vector>

#include "sim/mesh/hinges.h"
#include "sim/mesh/topology.h"
#include "sim/mesh/vec4d.h"
#include "sim/mesh/vertex_array.h"

namespace pneuma::sim {

/// Over all coordinates of all vertices.
inline double dot(const VertexArray& a, const VertexArray& b) {
  return a.rows().cwiseProduct(b.rows()).sum();
}

class VertexMatrix {
 public:
  /// Refers to the topology, which must outlive it. `hinges`: null without.
  explicit VertexMatrix(const MeshTopology& topology, const HingeTable* hinges = nullptr);

  /// `diagonal` times the identity.
  void set_identity(double diagonal);

  void add(int vertex, const Mat3x4& block);  // symmetric
  /// The block of an edge in the rows of its first vertex and the columns of its second, and the
  /// transposed one in the mirrored position.
  void add_between(int edge, const Mat3x4& block) {
    const auto& [a, b] = topology_.edges()[at(edge)];
    add_between(a, b, edge, block);
  }
  /// Likewise of two vertices of a hinge.
  void add_between(int a, int b, const Mat3x4& block) { add_between(a, b, pair(a, b), block); }

  /// Adds to the whole diagonal.
  void add_identity(double diagonal);
  double max_diagonal() const;

  /// Fixes a coordinate of the active set: its row and column become those of the identity.
  void fix(int vertex, int axis);

  /// L D L^T without pivoting. False when a pivot is zero.
  [[nodiscard]] bool factorize();
  /// Of the eigenvalues, as many are negative as of D (Sylvester's law of inertia).
  int negative_count() const { return negative_count_; }

  /// Replaces the right side by the solution. After a successful factorize().
  void solve(VertexArray& values) const;

  /// The matrix itself times `values`.
  void multiply(const VertexArray& values, VertexArray& product) const;
  Mat3 diagonal_block(int vertex) const;

 private:
  using Sparse = Eigen::SparseMatrix<double>;

  /// Of a matrix whose columns are in their order already. What Eigen's own functions do, without
  /// the copies of the matrix and of D that they allocate.
  struct Factor : Eigen::SimplicialLDLT<Sparse, Eigen::Upper, Eigen::NaturalOrdering<int>> {
    void factorize_in_order(const Sparse& matrix) { factorize_preordered<true>(matrix); }
    Eigen::Index negative_count() const { return (m_diag.array() < 0.0).count(); }
  };

  /// Two vertices with a block: first the edges, in their order.
  using Pair = std::array<int, 2>;

  void find_pairs(const HingeTable* hinges);
  void order();
  void make_pattern();
  int pair(int a, int b) const;
  void add_between(int a, int b, int pair, const Mat3x4& block);
  void add_above(int rank, int pair, const Mat3x4& block);
  Vec4d multiply_row(int rank) const;
  void put_in_order(const VertexArray& values) const;  // into right_
  void take_from_order(VertexArray& values) const;     // from solution_

  const MeshTopology& topology_;
  std::vector<int> rank_;         // of each vertex in the order of elimination
  std::vector<Pair> pairs_;       // those that are no edges are sorted, lower index first
  std::vector<int> pair_offset_;  // of a pair's block in each column of its later vertex
  std::vector<int> pairs_begin_;  // per vertex, into vertex_pairs_
  std::vector<int> vertex_pairs_;
  std::vector<int> diagonal_offset_;  // of a vertex' own block in each of its columns
  Sparse upper_;
  Factor factor_;
  int negative_count_ = 0;
  mutable Eigen::VectorXd right_, solution_;
  mutable VertexArray ordered_, ordered_product_;
};

}  // namespace pneuma::sim

#include "sim/soft/vertex_matrix.h"

#include <algorithm>
#include <array>

namespace pneuma::sim {

VertexMatrix::VertexMatrix(const MeshTopology& topology) : topology_(topology) {
  order();
  make_pattern();
  set_identity(1.0);
  factor_.analyzePattern(upper_);
  right_.resize(upper_.rows());
  solution_.resize(upper_.rows());
}

void VertexMatrix::order() {
  const int count = topology_.vertex_count();
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < count; ++v) entries.emplace_back(v, v, 1.0);
  for (const auto& [a, b] : topology_.edges()) {
    entries.emplace_back(a, b, 1.0);
    entries.emplace_back(b, a, 1.0);
  }
  Sparse graph(count, count);
  graph.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> from_rank;
  Eigen::AMDOrdering<int>()(graph, from_rank);
  rank_.resize(at(count));
  for (int rank = 0; rank < count; ++rank) rank_[at(from_rank.indices()[rank])] = rank;
}

void VertexMatrix::make_pattern() {
  const int count = topology_.vertex_count();
  // Per rank: the edges to vertices of lower rank.
  std::vector<std::vector<std::array<int, 2>>> earlier(at(count));
  for (int e = 0; e < topology_.edge_count(); ++e) {
    const auto& [a, b] = topology_.edges()[at(e)];
    const auto [low, high] = std::minmax(rank_[at(a)], rank_[at(b)]);
    earlier[at(high)].push_back({low, e});
  }
  std::vector<Eigen::Triplet<double>> entries;
  edge_offset_.resize(at(topology_.edge_count()));
  diagonal_offset_.resize(at(count));
  for (int rank = 0; rank < count; ++rank) {
    auto& edges = earlier[at(rank)];
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      edge_offset_[at(edges[i][1])] = 3 * static_cast<int>(i);
    }
    diagonal_offset_[at(rank)] = 3 * static_cast<int>(edges.size());
    for (int axis = 0; axis < 3; ++axis) {
      const int column = 3 * rank + axis;
      for (const auto& [other, edge] : edges) {
        for (int row = 0; row < 3; ++row) entries.emplace_back(3 * other + row, column, 1.0);
      }
      for (int row = 0; row <= axis; ++row) entries.emplace_back(3 * rank + row, column, 1.0);
    }
  }
  upper_.resize(3 * count, 3 * count);
  upper_.setFromTriplets(entries.begin(), entries.end());
  upper_.makeCompressed();
}

void VertexMatrix::set_identity(double diagonal) {
  std::fill_n(upper_.valuePtr(), upper_.nonZeros(), 0.0);
  add_identity(diagonal);
}

void VertexMatrix::add_identity(double diagonal) {
  for (int column = 0; column < upper_.cols(); ++column) {
    upper_.valuePtr()[upper_.outerIndexPtr()[column + 1] - 1] += diagonal;
  }
}

double VertexMatrix::max_diagonal() const {
  double max = 0.0;
  for (int column = 0; column < upper_.cols(); ++column) {
    max = std::max(max, upper_.valuePtr()[upper_.outerIndexPtr()[column + 1] - 1]);
  }
  return max;
}

void VertexMatrix::add(int vertex, const Mat3& block) {
  const int rank = rank_[at(vertex)];
  for (int column = 0; column < 3; ++column) {
    double* values =
        upper_.valuePtr() + upper_.outerIndexPtr()[3 * rank + column] + diagonal_offset_[at(rank)];
    for (int row = 0; row <= column; ++row) values[row] += block(row, column);
  }
}

void VertexMatrix::add_between(int edge, const Mat3& block) {
  const auto& [a, b] = topology_.edges()[at(edge)];
  const bool in_order = rank_[at(a)] < rank_[at(b)];
  const int later = in_order ? rank_[at(b)] : rank_[at(a)];
  for (int column = 0; column < 3; ++column) {
    double* values =
        upper_.valuePtr() + upper_.outerIndexPtr()[3 * later + column] + edge_offset_[at(edge)];
    for (int row = 0; row < 3; ++row) {
      values[row] += in_order ? block(row, column) : block(column, row);
    }
  }
}

void VertexMatrix::fix(int vertex, int axis) {
  const int rank = rank_[at(vertex)];
  for (const auto& spoke : topology_.ring(vertex)) {
    const int other = rank_[at(spoke.vertex)];
    for (int i = 0; i < 3; ++i) {
      const int column = other < rank ? 3 * rank + axis : 3 * other + i;
      const int row = other < rank ? i : axis;
      upper_.valuePtr()[upper_.outerIndexPtr()[column] + edge_offset_[at(spoke.edge)] + row] = 0.0;
    }
  }
  for (int i = 0; i < 3; ++i) {
    const auto [row, column] = std::minmax(i, axis);
    upper_
        .valuePtr()[upper_.outerIndexPtr()[3 * rank + column] + diagonal_offset_[at(rank)] + row] =
        i == axis ? 1.0 : 0.0;
  }
}

bool VertexMatrix::factorize() {
  factor_.factorize_in_order(upper_);
  if (factor_.info() != Eigen::Success) return false;
  negative_count_ = static_cast<int>(factor_.negative_count());
  return true;
}

void VertexMatrix::solve(VertexArray& values) const {
  put_in_order(values);
  solution_ = factor_.solve(right_);
  take_from_order(values);
}

void VertexMatrix::multiply(const VertexArray& values, VertexArray& product) const {
  put_in_order(values);
  solution_.noalias() = upper_.selfadjointView<Eigen::Upper>() * right_;
  take_from_order(product);
}

Mat3 VertexMatrix::diagonal_block(int vertex) const {
  Mat3 block;
  const int rank = rank_[at(vertex)];
  for (int column = 0; column < 3; ++column) {
    const double* values =
        upper_.valuePtr() + upper_.outerIndexPtr()[3 * rank + column] + diagonal_offset_[at(rank)];
    for (int row = 0; row <= column; ++row) block(row, column) = block(column, row) = values[row];
  }
  return block;
}

void VertexMatrix::put_in_order(const VertexArray& values) const {
  for (int v = 0; v < values.size(); ++v) right_.segment<3>(3 * rank_[at(v)]) = values[v];
}

void VertexMatrix::take_from_order(VertexArray& values) const {
  for (int v = 0; v < values.size(); ++v) values[v] = solution_.segment<3>(3 * rank_[at(v)]);
}

}  // namespace pneuma::sim

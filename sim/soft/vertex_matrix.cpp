#include "sim/soft/vertex_matrix.h"

#include <algorithm>
#include <numeric>

namespace pneuma::sim {

VertexMatrix::VertexMatrix(const MeshTopology& topology, const HingeTable* hinges)
    : topology_(topology) {
  find_pairs(hinges);
  order();
  make_pattern();
  set_identity(1.0);
  factor_.analyzePattern(upper_);
  right_.resize(upper_.rows());
  solution_.resize(upper_.rows());
  ordered_ = ordered_product_ = VertexArray(topology.vertex_count());
}

void VertexMatrix::find_pairs(const HingeTable* hinges) {
  pairs_ = topology_.edges();
  const std::ptrdiff_t edges = topology_.edge_count();
  for (std::size_t e = 0; hinges && e < hinges->corners.size(); ++e) {
    const auto [low, high] = std::minmax(hinges->corners[e][2], hinges->corners[e][3]);
    const Pair across = {low, high};
    if (low != high && !std::binary_search(pairs_.begin(), pairs_.begin() + edges, across)) {
      pairs_.push_back(across);
    }
  }
  std::sort(pairs_.begin() + edges, pairs_.end());
  pairs_.erase(std::unique(pairs_.begin() + edges, pairs_.end()), pairs_.end());

  pairs_begin_.assign(at(topology_.vertex_count()) + 1, 0);
  for (const auto& [a, b] : pairs_) {
    ++pairs_begin_[at(a) + 1];
    ++pairs_begin_[at(b) + 1];
  }
  std::partial_sum(pairs_begin_.begin(), pairs_begin_.end(), pairs_begin_.begin());
  vertex_pairs_.resize(2 * pairs_.size());
  std::vector<int> next = pairs_begin_;
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    for (const int v : pairs_[p]) vertex_pairs_[at(next[at(v)]++)] = static_cast<int>(p);
  }
}

int VertexMatrix::pair(int a, int b) const {
  const Pair wanted = {std::min(a, b), std::max(a, b)};
  const auto edges_end = pairs_.begin() + topology_.edge_count();
  const auto edge = std::lower_bound(pairs_.begin(), edges_end, wanted);
  const bool is_edge = edge != edges_end && *edge == wanted;
  const auto found = is_edge ? edge : std::lower_bound(edges_end, pairs_.end(), wanted);
  return static_cast<int>(found - pairs_.begin());
}

void VertexMatrix::order() {
  const int count = topology_.vertex_count();
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < count; ++v) entries.emplace_back(v, v, 1.0);
  for (const auto& [a, b] : pairs_) {
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
  // Per rank: the pairs with vertices of lower rank.
  std::vector<std::vector<std::array<int, 2>>> earlier(at(count));
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const auto [low, high] = std::minmax(rank_[at(pairs_[p][0])], rank_[at(pairs_[p][1])]);
    earlier[at(high)].push_back({low, static_cast<int>(p)});
  }
  std::vector<Eigen::Triplet<double>> entries;
  pair_offset_.resize(pairs_.size());
  diagonal_offset_.resize(at(count));
  for (int rank = 0; rank < count; ++rank) {
    auto& with = earlier[at(rank)];
    std::sort(with.begin(), with.end());
    for (std::size_t i = 0; i < with.size(); ++i) {
      pair_offset_[at(with[i][1])] = 3 * static_cast<int>(i);
    }
    diagonal_offset_[at(rank)] = 3 * static_cast<int>(with.size());
    for (int axis = 0; axis < 3; ++axis) {
      const int column = 3 * rank + axis;
      for (const auto& [other, pair] : with) {
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

void VertexMatrix::add(int vertex, const Mat3x4& block) {
  const int rank = rank_[at(vertex)];
  for (int column = 0; column < 3; ++column) {
    double* values =
        upper_.valuePtr() + upper_.outerIndexPtr()[3 * rank + column] + diagonal_offset_[at(rank)];
    for (int row = 0; row <= column; ++row) values[row] += block.columns[at(column)][row];
  }
}

void VertexMatrix::add_between(int a, int b, int pair, const Mat3x4& block) {
  if (rank_[at(a)] < rank_[at(b)]) {
    add_above(rank_[at(b)], pair, block);
  } else {
    add_above(rank_[at(a)], pair, transposed(block));
  }
}

/// In the columns of a pair's later vertex. The fourth number of a block's column is 0, and what it
/// is added to is of the same column.
void VertexMatrix::add_above(int rank, int pair, const Mat3x4& block) {
  const int* const columns = upper_.outerIndexPtr() + 3 * rank;
  double* const first = upper_.valuePtr() + pair_offset_[at(pair)];
  for (std::size_t i = 0; i < 3; ++i) {
    double* const values = first + columns[i];
    store_vec4d(load_vec4d(values) + block.columns[i], values);
  }
}

void VertexMatrix::fix(int vertex, int axis) {
  const int rank = rank_[at(vertex)];
  for (int i = pairs_begin_[at(vertex)]; i < pairs_begin_[at(vertex) + 1]; ++i) {
    const int pair = vertex_pairs_[at(i)];
    const int other =
        rank_[at(pairs_[at(pair)][0] == vertex ? pairs_[at(pair)][1] : pairs_[at(pair)][0])];
    for (int j = 0; j < 3; ++j) {
      const int column = other < rank ? 3 * rank + axis : 3 * other + j;
      const int row = other < rank ? j : axis;
      upper_.valuePtr()[upper_.outerIndexPtr()[column] + pair_offset_[at(pair)] + row] = 0.0;
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
  for (int v = 0; v < values.size(); ++v) ordered_[rank_[at(v)]] = values[v];
  for (int rank = 0; rank < values.size(); ++rank) {
    VertexWriter(ordered_product_).put(rank, multiply_row(rank));
  }
  for (int v = 0; v < values.size(); ++v) product[v] = ordered_product_[rank_[at(v)]];
}

/// Of the blocks on and left of the diagonal; adds what those above it, the same ones transposed,
/// come to in the products of lower ranks. With a block's column of three numbers the one behind
/// them is read: it comes into nothing but the fourth number of a product, which nobody reads.
Vec4d VertexMatrix::multiply_row(int rank) const {
  const VertexReader x(ordered_), before(ordered_product_);
  const VertexWriter after(ordered_product_);
  std::array<const double*, 3> columns;
  for (int i = 0; i < 3; ++i) {
    columns[at(i)] = upper_.valuePtr() + upper_.outerIndexPtr()[3 * rank + i];
  }
  const int* rows = upper_.innerIndexPtr() + upper_.outerIndexPtr()[3 * rank];
  const Vec4d own = x[rank];
  std::array<Vec4d, 3> products{};
  const int diagonal = diagonal_offset_[at(rank)];
  for (int i = 0; i < diagonal; i += 3) {
    const int other = rows[i] / 3;
    Vec4d of_other = before[other];
    for (std::size_t j = 0; j < 3; ++j) {
      const Vec4d column = load_vec4d(columns[j] + i);
      of_other = fma(own[static_cast<int>(j)], column, of_other);
      products[j] = fma(column, x[other], products[j]);
    }
    after.put(other, of_other);
  }
  const Vec3x4 sums = to_columns(products[0], products[1], products[2], Vec4d{});
  const double* const a = columns[0] + diagonal;
  const double* const b = columns[1] + diagonal;
  const double* const c = columns[2] + diagonal;
  const Mat3x4 block{{Vec4d{a[0], b[0], c[0]}, Vec4d{b[0], b[1], c[1]}, Vec4d{c[0], c[1], c[2]}}};
  return sums.x + sums.y + sums.z + block * own;
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

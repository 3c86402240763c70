// A sparse symmetric system, solved directly: L L^T within the envelope of the matrix, row by row
// (George and Liu, Computer Solution of Large Sparse Positive Definite Systems, 1981, chapter 4).
// What is zero before the first entry of a row stays zero, so that rows of few entries near the
// diagonal, as a stack of bodies makes them, cost little.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace pneuma::sim {

class EnvelopeCholesky {
 public:
  /// All entries zero. `first`: the column of the first entry of each row, <= the row.
  void reset(std::span<const int> first);

  /// Entry (row, column) of the lower triangle, within the envelope.
  double& entry(int row, int column) {
    return entries_[begin_[static_cast<std::size_t>(row)] + static_cast<std::size_t>(column)];
  }

  /// Whether the matrix is positive definite. Its entries are lost.
  bool factor();
  /// The solution in place of the right side, after factor().
  void solve(std::span<double> right) const;

 private:
  /// Rows from `begin`, so many, which begin in the same column: their entries before that of row
  /// `begin`, each group of inner products with an earlier row at once.
  template <std::size_t rows>
  void reduce(std::size_t begin);
  void reduce(std::size_t begin, std::size_t rows);
  /// The entries from column `first` on, and the pivot: false if that is not positive.
  bool finish_row(std::size_t i, std::size_t first);
  const double* row(std::size_t i) const { return entries_.data() + begin_[i]; }

  std::vector<std::size_t> first_;
  std::vector<std::size_t>
      begin_;  // of row i in entries_, less first_[i]: column j is at begin + j
  std::vector<double> entries_;
};

}  // namespace pneuma::sim

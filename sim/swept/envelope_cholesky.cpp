#include "sim/swept/envelope_cholesky.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace pneuma::sim {
namespace {

double inner_product(const double* a, const double* b, std::size_t count) {
  using Row = Eigen::Map<const Eigen::VectorXd>;
  const auto size = static_cast<Eigen::Index>(count);
  return Row(a, size).dot(Row(b, size));
}

}  // namespace

void EnvelopeCholesky::reset(std::span<const int> first) {
  first_.assign(first.begin(), first.end());
  begin_.clear();
  std::size_t size = 0;
  for (std::size_t i = 0; i < first_.size(); ++i) {
    begin_.push_back(size - first_[i]);
    size += i - first_[i] + 1;
  }
  entries_.assign(size, 0.0);
}

bool EnvelopeCholesky::factor() {
  for (std::size_t i = 0; i < first_.size(); ++i) {
    double* const of_i = entries_.data() + begin_[i];
    for (std::size_t j = first_[i]; j < i; ++j) {
      const std::size_t from = std::max(first_[i], first_[j]);
      if (from < j) of_i[j] -= inner_product(of_i + from, row(j) + from, j - from);
      of_i[j] /= row(j)[j];
    }
    const double pivot = of_i[i] - inner_product(of_i + first_[i], of_i + first_[i], i - first_[i]);
    if (!(pivot > 0.0)) return false;
    of_i[i] = std::sqrt(pivot);
  }
  return true;
}

void EnvelopeCholesky::solve(std::span<double> right) const {
  for (std::size_t i = 0; i < first_.size(); ++i) {
    const std::size_t from = first_[i];
    right[i] -= inner_product(row(i) + from, right.data() + from, i - from);
    right[i] /= row(i)[i];
  }
  for (std::size_t i = first_.size(); i-- > 0;) {
    right[i] /= row(i)[i];
    for (std::size_t j = first_[i]; j < i; ++j) right[j] -= row(i)[j] * right[i];
  }
}

}  // namespace pneuma::sim

#include "sim/swept/envelope_cholesky.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "sim/mesh/vec4d.h"

namespace pneuma::sim {
namespace {

/// That are reduced at once: the unknowns of a box.
constexpr std::size_t most_rows = 6;

double inner_product(const double* a, const double* b, std::size_t count) {
  using Row = Eigen::Map<const Eigen::VectorXd>;
  const auto size = static_cast<Eigen::Index>(count);
  return Row(a, size).dot(Row(b, size));
}

/// Of several rows with one, which is read once. Each sum is in the order of Eigen's with AVX: what
/// is grouped changes no bit of it.
template <std::size_t rows>
std::array<double, rows> inner_products(const std::array<const double*, rows>& of,
                                        const double* other, std::size_t count) {
  constexpr std::size_t lanes = 4;
  std::array<double, rows> sums{};
  const auto products = [&](std::size_t k, std::size_t i) {
    return load_vec4d(of[k] + i) * load_vec4d(other + i);
  };
  const std::size_t end = count / lanes * lanes, end_of_pairs = count / (2 * lanes) * (2 * lanes);
  std::size_t i = 0;
  if (end > 0) {
    std::array<Vec4d, rows> even{}, odd{};
    for (std::size_t k = 0; k < rows; ++k) even[k] = products(k, 0);
    if (end > lanes) {
      for (std::size_t k = 0; k < rows; ++k) odd[k] = products(k, lanes);
      for (i = 2 * lanes; i < end_of_pairs; i += 2 * lanes) {
        for (std::size_t k = 0; k < rows; ++k) {
          even[k] += products(k, i);
          odd[k] += products(k, i + lanes);
        }
      }
      for (std::size_t k = 0; k < rows; ++k) even[k] += odd[k];
      if (end > end_of_pairs) {
        for (std::size_t k = 0; k < rows; ++k) even[k] += products(k, end_of_pairs);
      }
    }
    for (std::size_t k = 0; k < rows; ++k) {
      sums[k] = (even[k][0] + even[k][2]) + (even[k][1] + even[k][3]);
    }
  }
  for (i = end; i < count; ++i) {
    for (std::size_t k = 0; k < rows; ++k) sums[k] += of[k][i] * other[i];
  }
  return sums;
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
  for (std::size_t begin = 0; begin < first_.size();) {
    std::size_t end = begin + 1;
    while (end < first_.size() && end < begin + most_rows && first_[end] == first_[begin]) ++end;
    reduce(begin, end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      if (!finish_row(i, begin)) return false;
    }
    begin = end;
  }
  return true;
}

void EnvelopeCholesky::reduce(std::size_t begin, std::size_t rows) {
  switch (rows) {
    case 6:
      return reduce<6>(begin);
    case 5:
      return reduce<5>(begin);
    case 4:
      return reduce<4>(begin);
    case 3:
      return reduce<3>(begin);
    case 2:
      return reduce<2>(begin);
    default:
      return reduce<1>(begin);
  }
}

template <std::size_t rows>
void EnvelopeCholesky::reduce(std::size_t begin) {
  std::array<double*, rows> of{};
  for (std::size_t k = 0; k < rows; ++k) of[k] = entries_.data() + begin_[begin + k];
  for (std::size_t j = first_[begin]; j < begin; ++j) {
    const std::size_t from = std::max(first_[begin], first_[j]);
    std::array<const double*, rows> before{};
    for (std::size_t k = 0; k < rows; ++k) before[k] = of[k] + from;
    const auto products = inner_products(before, row(j) + from, j - from);
    const double pivot = row(j)[j];
    for (std::size_t k = 0; k < rows; ++k) of[k][j] = (of[k][j] - products[k]) / pivot;
  }
}

bool EnvelopeCholesky::finish_row(std::size_t i, std::size_t first) {
  double* const of_i = entries_.data() + begin_[i];
  for (std::size_t j = first; j < i; ++j) {
    const std::size_t from = std::max(first_[i], first_[j]);
    if (from < j) of_i[j] -= inner_product(of_i + from, row(j) + from, j - from);
    of_i[j] /= row(j)[j];
  }
  const double pivot = of_i[i] - inner_product(of_i + first_[i], of_i + first_[i], i - first_[i]);
  if (!(pivot > 0.0)) return false;
  of_i[i] = std::sqrt(pivot);
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

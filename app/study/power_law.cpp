#include "app/study/power_law.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pneuma::app {
namespace {

void check(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size()) throw std::invalid_argument("a power law through unpaired values");
  if (x.size() < 2) throw std::invalid_argument("a power law through fewer than two points");
  const auto loggable = [](double value) { return std::isfinite(value) && value > 0.0; };
  if (!std::ranges::all_of(x, loggable) || !std::ranges::all_of(y, loggable)) {
    throw std::invalid_argument("a power law through a value that has no logarithm");
  }
}

std::vector<double> logarithms(std::span<const double> values) {
  std::vector<double> result;
  for (const double value : values) result.push_back(std::log(value));
  return result;
}

}  // namespace

Line fit_line(std::span<const double> x, std::span<const double> y) {
  const auto count = static_cast<double>(x.size());
  double mean_x = 0.0, mean_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / count;
    mean_y += y[i] / count;
  }
  double xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return {xy / xx, mean_y - xy / xx * mean_x};
}

PowerLaw fit_power_law(std::span<const double> x, std::span<const double> y) {
  check(x, y);
  if (std::ranges::all_of(x, [&](double value) { return value == x[0]; })) {
    throw std::invalid_argument("a power law through points of one x");
  }
  const Line line = fit_line(logarithms(x), logarithms(y));
  return {line.slope, std::exp(line.start)};
}

std::vector<double> local_exponents(std::span<const double> x, std::span<const double> y) {
  check(x, y);
  std::vector<double> exponents;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    if (x[i] == x[i + 1]) throw std::invalid_argument("a power law through points of one x");
    exponents.push_back(std::log(y[i + 1] / y[i]) / std::log(x[i + 1] / x[i]));
  }
  return exponents;
}

std::optional<PointRange> power_law_range(std::span<const double> x, std::span<const double> y,
                                          double band) {
  if (x.size() < 3) return std::nullopt;
  const std::vector<double> exponents = local_exponents(x, y);
  std::optional<PointRange> longest;
  for (std::size_t first = 0; first < exponents.size(); ++first) {
    double low = exponents[first], high = exponents[first];
    for (std::size_t last = first + 1; last < exponents.size(); ++last) {
      low = std::min(low, exponents[last]);
      high = std::max(high, exponents[last]);
      if (high - low > band) break;
      const PointRange range{first, last + 1};
      if (!longest || range.count() >= longest->count()) longest = range;
    }
  }
  return longest;
}

}  // namespace pneuma::app

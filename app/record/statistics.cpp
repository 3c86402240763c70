#include "app/record/statistics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pneuma::app {

double percentile(std::span<const double> sorted, double percent) {
  if (sorted.empty()) throw std::invalid_argument("a percentile of no values");
  if (!(percent >= 0.0 && percent <= 100.0)) {
    throw std::invalid_argument("a percentile is of 0 to 100 percent");
  }
  const double rank = percent / 100.0 * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], rank - std::floor(rank));
}

Spread spread(std::vector<double> values) {
  std::ranges::sort(values);
  return {percentile(values, 5.0), percentile(values, 50.0), percentile(values, 95.0)};
}

Spread inverse(const Spread& spread) {
  return {1.0 / spread.high, 1.0 / spread.median, 1.0 / spread.low};
}

}  // namespace pneuma::app

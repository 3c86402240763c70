// Order statistics of measured times.
#pragma once

#include <span>
#include <vector>

namespace pneuma::app {

/// The value below which `percent` (0..100) of the values lie, linear between the two nearest ranks
/// (Hyndman and Fan's type 7: 0 is the min., 100 the max.). `sorted` is in ascending
/// order and not empty; throws std::invalid_argument otherwise for an empty span or a percent out
/// of range.
double percentile(std::span<const double> sorted, double percent);

/// Where most of a sample lies.
struct Spread {
  double low = 0.0;  // 5th percentile
  double median = 0.0;
  double high = 0.0;  // 95th percentile
};

/// `values` in any order, not empty.
Spread spread(std::vector<double> values);

/// The spread of 1 / value: of a rate when the values are times. Low and high change places.
Spread inverse(const Spread& spread);

}  // namespace pneuma::app

// A fine sphere on the ground, by each side at the cheapest setting that holds its shape.
#pragma once

#include <string>
#include <vector>

namespace pneuma::benchmarks {

/// A setting, what it costs, and how well it does.
struct QualityTry {
  std::string setting;
  double seconds_per_second = 0.0;  // of processor time per simulated second
  double volume_error = 0.0;        // |V - V exact| / V exact, greatest over the last second
  bool good() const { return volume_error <= 0.1; }
};

struct QualityComparison {
  int vertices = 0;
  std::vector<QualityTry> bullet;  // as tried
  std::vector<QualityTry> ours;
};

/// The cheapest good one; null if none is.
const QualityTry* cheapest_good(const std::vector<QualityTry>& tries);

/// An icosphere of so many subdivisions under the gas and on the ground. The exact volume is for
/// ours that of the same body at rest, found with small steps and strong drag; for Bullet, whose
/// links are constraints, the volume at which none is stretched: that of the start. Runs of
/// `seconds` simulated seconds.
QualityComparison compare_quality(int subdivisions, double seconds);

}  // namespace pneuma::benchmarks

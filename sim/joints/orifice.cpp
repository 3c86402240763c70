#include "sim/joints/orifice.h"

#include <algorithm>
#include <cmath>

#include "sim/world/soft_body.h"

namespace pneuma::sim {
namespace {

constexpr double molar_mass = 0.0289644;  // kg/mol
constexpr double heat_ratio = 1.4;
constexpr double laminar_from = 0.999;

/// J sqrt(M R T) / P.
double jet(double ratio) {
  static const double choked = std::pow(2.0 / (heat_ratio + 1.0), heat_ratio / (heat_ratio - 1.0));
  const double r = std::max(ratio, choked);
  const double root = std::pow(r, 1.0 / heat_ratio);
  return std::sqrt(2.0 * heat_ratio / (heat_ratio - 1.0) * (root * root - r * root));
}

}  // namespace

double orifice_flux(double from_pressure, double from_temperature, double to_pressure) {
  if (!(from_pressure > to_pressure)) return 0.0;
  const double ratio = to_pressure / from_pressure;
  const double scale = from_pressure / std::sqrt(molar_mass * gas_constant * from_temperature);
  if (ratio <= laminar_from) return scale * jet(ratio);
  static const double slope = jet(laminar_from) / (1.0 - laminar_from);
  return scale * slope * (1.0 - ratio);
}

}  // namespace pneuma::sim

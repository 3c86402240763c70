// The functions of one number that the contact potential is made of.
//
// Barrier: f(s) = -(s - 1)^2 ln s for 0 < s < 1, of the distance s in units of the reach, and 0
// beyond (Li et al., Incremental Potential Contact, 2020, equation 6, with the distance in place of
// its square, as in Li et al., Convergent Incremental Potential Contact, 2023). It is twice
// continuously differentiable and grows without bound as s -> 0.
#pragma once

#include <cmath>
#include <limits>

namespace pneuma::sim {

struct FunctionValue {
  double value = 0.0;
  double slope = 0.0;
  double curvature = 0.0;
};

/// Not finite at s <= 0.
inline FunctionValue barrier(double s) {
  if (s >= 1.0) return {};
  if (!(s > 0.0)) {
    const double endless = std::numeric_limits<double>::infinity();
    return {endless, -endless, endless};
  }
  const double less = s - 1.0, log = std::log(s);
  return {-less * less * log, -2.0 * less * log - less * less / s,
          -2.0 * log - 4.0 * less / s + less * less / (s * s)};
}

/// J, of a distance in m: `strength` is in N.
inline FunctionValue barrier_at(double distance, double reach, double strength) {
  const FunctionValue f = barrier(distance / reach);
  return {strength * reach * f.value, strength * f.slope, strength / reach * f.curvature};
}

/// Smoothed Coulomb friction over its bound, of the sliding speed in units of the regularisation
/// speed (Li et al. 2020, section 5.2): the value is the work per unit of speed, the slope rises
/// from 0 to 1 and is once continuously differentiable. y >= 0.
inline FunctionValue smooth_friction(double y) {
  if (y >= 1.0) return {y, 1.0, 0.0};
  return {1.0 / 3.0 + y * y - y * y * y / 3.0, 2.0 * y - y * y, 2.0 - 2.0 * y};
}

/// How much of what restitution takes away acts, of the speed of parting in units of the
/// regularisation speed: the slope rises from 0 at q <= 0 to 1 at q >= 1, once continuously
/// differentiable; the value is its integral.
inline FunctionValue parting_ramp(double q) {
  if (q <= 0.0) return {};
  if (q >= 1.0) return {q - 0.5, 1.0, 0.0};
  return {q * q * q * (1.0 - 0.5 * q), q * q * (3.0 - 2.0 * q), 6.0 * q * (1.0 - q)};
}

}  // namespace pneuma::sim

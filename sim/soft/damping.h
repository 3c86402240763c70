// Damping (paper 3.1.3), in the two readings of ERRATA row 5.
//
// The paper takes rho v off the velocity in every step of 1/60 s, rho = rho_g + (1 - rho_g) k /
// k_max. That is (1 - rho) = (1 - rho_g)(1 - k / k_max): two decays one after the other, a global
// one and the springs'. `literal` does just this. `dashpot` is the differential equation that loses
// the same fraction in 1/60 s: drag with the rate -60 ln(1 - rho_g) on the velocity, and along each
// spring a dashpot c with which two vertices of mass m on one spring, alone, approach each other
// more slowly at the rate 2 c / m = -60 ln(1 - k / k_max). Unlike `literal` it does not depend on
// the step, and the springs' part conserves momentum, so it does not hold a falling body back.
#pragma once

#include "sim/world/soft_body.h"

namespace pneuma::sim {

/// A spring at or beyond k_max would lose everything at once; no spring loses more than this
/// fraction of its ends' relative velocity in 1/60 s.
inline constexpr double max_spring_fraction = 0.99;

/// Rate of the drag on the whole velocity, 1/s. Zero under `literal`.
double drag_rate(const SoftMaterial& material);

/// Dashpot constant c of each spring, N s/m. Zero under `literal`.
double dashpot_constant(const SoftMaterial& material);

/// The paper's rho, lost per step whatever its length, at most 1. Zero under `dashpot`.
double literal_fraction(const SoftMaterial& material);

}  // namespace pneuma::sim

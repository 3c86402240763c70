// The model's differential equation (README "The model") once more, written down from its formula
// and not from the simulation's code: one scalar after the other, no weights or constants taken
// over. What it shares with the fast code is the plain data: positions, springs, triangles,
// material.
//
//   m dv/dt = sum_springs [k (l - L) + c (v_rel . d)] d  +  w P dV/dx  +  m g  -  gamma m v
#pragma once

#include <span>
#include <vector>

#include "sim/world/world.h"

namespace pneuma::app {

class ReferenceEquation {
 public:
  /// Refers to the bodies, which must outlive it; their positions and velocities are not used.
  /// Damping must not be `literal`, which is no differential equation: throws
  /// std::invalid_argument.
  ReferenceEquation(std::span<const sim::SoftBody> bodies, const sim::Vec3& gravity);

  /// dy/dt of a state as flat_state has it. False when the volume of a body with gas is not above
  /// zero: the state has no meaning.
  bool operator()(const double* state, double* derivative) const;

 private:
  std::span<const sim::SoftBody> bodies_;
  sim::Vec3 gravity_;
  std::vector<std::vector<double>> pressure_weights_;  // w, per body and vertex
  std::size_t vertices_ = 0;                           // of all bodies
};

/// All positions, body by body, as x y z x y z ..., then all velocities likewise.
std::vector<double> flat_state(std::span<const sim::SoftBody> bodies);

/// The reverse, into bodies of the same sizes.
void read_flat_state(std::span<const double> state, std::span<sim::SoftBody> bodies);

}  // namespace pneuma::app

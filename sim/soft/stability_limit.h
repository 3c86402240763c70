// The longest step with which an explicit integrator stays stable, predicted from small motions.
//
// A linear method makes of a motion x'' = -omega^2 x - delta x' the product of (x, v) with a matrix
// that depends on h omega and h delta alone. It is stable while no eigenvalue of it exceeds 1 in
// size: on undamped motions up to h omega = 2 for martin, symplectic_euler and velocity_verlet, 2
// sqrt 2 for rk4 and 5.97 for rk8. The matrix is taken from the integrators themselves. The fastest
// motion of a body is that of the largest eigenvalue of its springs and gas; dashpots may make
// another one the first to fail. So the fastest of both together are looked at too, with more and
// more weight of the dashpots, and those that die away without swinging, as exp(-r t) with r^2 - r
// delta + omega^2 = 0: by rk4 and rk8 such a one is stable up to a step of R / r (R = 2.785 for
// rk4), and fails at h if (R / h) delta - omega^2 > (R / h)^2.
//
// Small motions are those of a body at rest. One that is hit hard, whose springs are drawn out to
// many times their length, or that presses its gas together, is stiffer.
#pragma once

#include <functional>

#include "sim/mesh/soft_mesh.h"
#include "sim/soft/vibration_mode.h"
#include "sim/world/settings.h"

namespace pneuma::sim {

struct StabilityLimit {
  double step = 0.0;   // s; infinite when no step is too long
  Oscillation motion;  // that which fails first
};

/// Of one motion. `kept`: the fraction of velocity that `literal` damping leaves after each step.
double stability_limit(Integrator integrator, const Oscillation& motion, double kept = 1.0);

/// Finds a motion by a weight.
using FindMotion = std::function<Oscillation(double weight)>;

/// The least over motions that `fastest` finds, each that of the largest squared_frequency + weight
/// * decay, and `most_damped`, if it is given, each that of the largest weight * decay -
/// squared_frequency.
StabilityLimit stability_limit(Integrator integrator, double kept, const FindMotion& fastest,
                               const FindMotion& most_damped = nullptr);

/// Of a body whose springs and gas are as at these positions.
StabilityLimit stability_limit(Integrator integrator, const SoftMesh& mesh,
                               const SoftMaterial& material, const VertexArray& positions);

/// Of a body that has come to rest from there, its gas having blown it up: the smaller of the
/// limits at these positions and at those, enlarged so far that springs and gas balance each other.
StabilityLimit settled_stability_limit(Integrator integrator, const SoftBody& body);

}  // namespace pneuma::sim

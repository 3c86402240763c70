// The explicit integrators of one soft body over one step.
#pragma once

#include "sim/soft/acceleration.h"

namespace pneuma::sim {

/// Memory for a step of any integrator on meshes of one shape.
struct IntegratorScratch {
  explicit IntegratorScratch(const SoftMesh& mesh);

  AccelerationScratch acceleration;
  VertexArray stage_acceleration, sum_a, sum_v;
};

/// Positions and velocities of one body at one moment.
struct SoftState {
  VertexArray positions;   // m
  VertexArray velocities;  // m/s
};

/// Writes into `positions` and `velocities` the state `step` seconds after `start`. Returns the
/// least of the volumes at which the force was evaluated (see SoftAcceleration): not above zero, or
/// not a number, when the step failed.
double integrate(Integrator integrator, const SoftAcceleration& acceleration, double step,
                 const SoftState& start, VertexArray& positions, VertexArray& velocities,
                 IntegratorScratch& scratch);

}  // namespace pneuma::sim

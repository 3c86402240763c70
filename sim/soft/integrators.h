// One step of one soft body by the explicit integrators. (By the implicit ones: implicit_step.h.)
#pragma once

#include <memory>

#include "sim/soft/acceleration.h"
#include "sim/soft/explicit_step.h"
#include "sim/soft/implicit_step.h"
#include "sim/soft/soft_state.h"

namespace pneuma::sim {

/// Memory for a step of one integrator on meshes of one shape.
struct IntegratorScratch {
  /// Refers to the mesh, which must outlive it.
  IntegratorScratch(const SoftMesh& mesh, Integrator integrator);

  AccelerationScratch acceleration;
  ExplicitScratch explicit_step;
  std::unique_ptr<ImplicitScratch> implicit;  // of implicit integrators
};

/// An explicit one. Writes into `positions` and `velocities` the state `step` seconds after
/// `start`. Returns the smallest of the volumes at which the force was evaluated (see
/// SoftAcceleration): not above zero, or not a number, when the step failed.
double integrate(Integrator integrator, const SoftAcceleration& acceleration, double step,
                 const SoftState& start, VertexArray& positions, VertexArray& velocities,
                 IntegratorScratch& scratch);

}  // namespace pneuma::sim

#include "sim/soft/integrators.h"

namespace pneuma::sim {

IntegratorScratch::IntegratorScratch(const SoftMesh& mesh, Integrator integrator)
    : acceleration(mesh), explicit_step(mesh.topology.vertex_count(), integrator) {
  if (is_implicit(integrator)) implicit = std::make_unique<ImplicitScratch>(mesh);
}

double integrate(Integrator integrator, const SoftAcceleration& acceleration, double step,
                 const SoftState& start, VertexArray& positions, VertexArray& velocities,
                 IntegratorScratch& scratch) {
  return explicit_step(integrator, acceleration, step, start, positions, velocities,
                       scratch.explicit_step);
}

}  // namespace pneuma::sim

#include <algorithm>

#include "sim/collision/particles.h"
#include "sim/step/stages.h"

namespace pneuma::sim {
namespace {

/// m. Particles nearer than a tenth of the skin cost no more than at that distance (ERRATA row 11);
/// without a skin this bounds the cost of particles in one place.
constexpr double least_particle_distance = 1e-6;

}  // namespace

void move_particles(World& world, StepWorkspace& workspace) {
  const double least_distance =
      std::max(0.1 * world.settings.skin_thickness, least_particle_distance);
  for (ParticlePair& pair : world.particles) {
    if (!pair.near) continue;
    const SoftBody& first = world.soft[at(pair.first)];
    const SoftBody& second = world.soft[at(pair.second)];
    settle_particles({first.mesh->topology, first.positions},
                     {second.mesh->topology, second.positions}, world.settings.particles,
                     least_distance, pair, workspace.particles);
  }
}

}  // namespace pneuma::sim

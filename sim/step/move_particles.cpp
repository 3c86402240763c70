#include "sim/collision/particles.h"
#include "sim/step/stages.h"

namespace pneuma::sim {

void move_particles(World& world, StepWorkspace& workspace) {
  const double least_distance = least_particle_distance(world.settings.skin_thickness);
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

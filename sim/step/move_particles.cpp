#include "sim/collision/particles.h"
#include "sim/step/stages.h"

namespace pneuma::sim {

void move_particles(World& world, StepWorkspace& workspace) {
  if (workspace.soft_pairs.empty()) return;  // none is near
  // Two references are all that std::function holds without allocating.
  const auto block = [&world, &workspace](int begin, int end, int thread) {
    const double least_distance = least_particle_distance(world.settings.skin_thickness);
    for (int i = begin; i < end; ++i) {
      ParticlePair& pair = world.particles[at(i)];
      if (!pair.near) continue;
      const SoftBody& first = world.soft[at(pair.first)];
      const SoftBody& second = world.soft[at(pair.second)];
      settle_particles({first.mesh->topology, first.positions},
                       {second.mesh->topology, second.positions}, world.settings.particles,
                       least_distance, pair, workspace.particles[at(thread)]);
    }
  };
  workspace.workers.for_blocks(static_cast<int>(world.particles.size()), block);
}

}  // namespace pneuma::sim

#include "sim/collision/particles.h"
#include "sim/step/stages.h"

namespace pneuma::sim {

void move_particles(World& world, const NearBodies& near_bodies, MoveParticlesMemory& memory,
                    base::Workers& workers) {
  if (near_bodies.soft_pairs.empty()) return;
  const auto block = [&](int begin, int end, int thread) {
    const double min_distance = min_particle_distance(world.settings.skin_thickness);
    for (int i = begin; i < end; ++i) {
      ParticlePair& pair = world.particles[at(i)];
      if (!pair.near) continue;
      const SoftBody& first = world.soft[at(pair.first)];
      const SoftBody& second = world.soft[at(pair.second)];
      settle_particles({first.mesh->topology, first.positions},
                       {second.mesh->topology, second.positions}, world.settings.particles,
                       min_distance, pair, memory.scratch[at(thread)]);
    }
  };
  workers.for_blocks(static_cast<int>(world.particles.size()), block);
}

}  // namespace pneuma::sim

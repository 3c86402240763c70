#include <limits>

#include "sim/response/depenetrate_pairs.h"
#include "sim/step/stages.h"

namespace pneuma::sim {
namespace {

/// A body moves by its own radius in the time in which surfaces part by a factor of e.
double radii_in_a_step(const Settings& settings) {
  if (settings.relaxation_time == 0.0) return std::numeric_limits<double>::infinity();
  return time_step(settings) / settings.relaxation_time;
}

}  // namespace

std::optional<Divergence> depenetrate(World& world, const NearBodies& near_bodies,
                                      DepenetrateMemory& memory) {
  if (near_bodies.overlapping_pairs.empty()) return std::nullopt;
  depenetrate_pairs(world, near_bodies.overlapping_pairs, radii_in_a_step(world.settings),
                    near_bodies.spheres, memory.scratch);
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    const DepenetrationScratch::Body& moved = memory.scratch.bodies[i];
    if (moved.way.allFinite() && moved.velocity.allFinite()) continue;
    return Divergence{Stage::depenetrate, world.steps + 1, world.soft[i].name,
                      "parting it from a body that it lies in moved it by what is not a finite "
                      "number: its vertices have next to no mass"};
  }
  return std::nullopt;
}

}  // namespace pneuma::sim

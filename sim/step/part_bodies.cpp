#include <limits>

#include "sim/response/part_deep_pairs.h"
#include "sim/step/stages.h"

namespace pneuma::sim {
namespace {

/// A body moves by its own radius in the time in which surfaces part by a factor of e.
double radii_in_a_step(const Settings& settings) {
  if (settings.separation_time == 0.0) return std::numeric_limits<double>::infinity();
  return time_step(settings) / settings.separation_time;
}

}  // namespace

std::optional<Divergence> part_bodies(World& world, StepWorkspace& workspace) {
  if (workspace.deep_pairs.empty()) return std::nullopt;
  part_deep_pairs(world, workspace.deep_pairs, radii_in_a_step(world.settings), workspace.spheres,
                  workspace.parting);
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    const PartingScratch::Body& moved = workspace.parting.bodies[i];
    if (moved.way.allFinite() && moved.velocity.allFinite()) continue;
    return Divergence{Stage::part_bodies, world.steps + 1, world.soft[i].name,
                      "parting it from a body that it lies in moved it by what is not a finite "
                      "number: its vertices have next to no mass"};
  }
  return std::nullopt;
}

}  // namespace pneuma::sim

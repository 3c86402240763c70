#include <utility>

#include "sim/soft/damping.h"
#include "sim/step/find_divergence.h"
#include "sim/step/stages.h"

namespace pneuma::sim {
namespace {

/// The state becomes the start of the step. What explicit integrators write they never read before:
/// the memory of the two states may change hands.
void hand_over(SoftBody& body, SoftState& start, bool keep) {
  if (keep || start.positions.size() != body.positions.size()) {
    start.positions = body.positions;
    start.velocities = body.velocities;
    return;
  }
  std::swap(start.positions, body.positions);
  std::swap(start.velocities, body.velocities);
}

std::optional<Divergence> integrate(const World& world, SoftBody& body, SoftState& start,
                                    IntegratorScratch& scratch) {
  const Settings& settings = world.settings;
  hand_over(body, start, is_implicit(settings.integrator));
  double least_volume = 0.0;
  if (scratch.implicit) {
    least_volume = implicit_step(*body.mesh, body.material, settings, start, body.positions,
                                 body.velocities, *scratch.implicit)
                       .volume;
  } else {
    const SoftAcceleration acceleration(*body.mesh, body.material, settings.gravity,
                                        scratch.acceleration);
    least_volume = integrate(settings.integrator, acceleration, time_step(settings), start,
                             body.positions, body.velocities, scratch);
  }
  if (body.material.damping == Damping::literal) {
    body.velocities.rows() *= 1.0 - literal_share(body.material);
  }
  return find_divergence(world, body, start, least_volume);
}

}  // namespace

std::optional<Divergence> integrate_soft(World& world, StepWorkspace& workspace) {
  const auto block = [&world, &workspace](int begin, int end, int thread) {
    for (int i = begin; i < end; ++i) {
      const int mesh = workspace.soft.mesh_of_body[at(i)];
      workspace.soft_outcome[at(i)] =
          integrate(world, world.soft[at(i)], workspace.soft_start[at(i)],
                    workspace.soft.per_thread[at(thread)][at(mesh)]);
    }
  };
  workspace.workers.for_blocks(static_cast<int>(world.soft.size()), block);
  for (const std::optional<Divergence>& outcome : workspace.soft_outcome) {
    if (outcome) return outcome;
  }
  return std::nullopt;
}

}  // namespace pneuma::sim

#include <cmath>
#include <sstream>

#include "sim/mesh/measure.h"
#include "sim/soft/damping.h"
#include "sim/soft/pressure_force.h"
#include "sim/step/stages.h"

namespace pneuma::sim {
namespace {

Divergence failure(const World& world, const SoftBody& body, const std::string& what) {
  return {Stage::integrate_soft, world.steps + 1, body.name, what};
}

/// Six digits, however small.
std::string text(double value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

std::string volume_report(double volume) {
  return "its volume is " + text(volume) +
         " m^3: the body turned inside out, because the step is too long for its springs or its "
         "gas";
}

/// By which a volume may grow from the least at which a step of an explicit integrator took its
/// force to its end. That force does not last: the gas would do far more work than it has to give.
constexpr double greatest_growth = 64.0;

/// A step ends soundly when every position is finite and a body with gas has a volume.
std::optional<Divergence> check(const World& world, const SoftBody& body, double least_volume) {
  const double sum = body.positions.rows().sum() + body.velocities.rows().sum();
  if (!std::isfinite(sum)) {
    return failure(world, body,
                   "a position or velocity is not a finite number: the step is too long");
  }
  if (gas_strength(body.material) == 0.0) return std::nullopt;
  if (!(least_volume > 0.0)) return failure(world, body, volume_report(least_volume));
  const double end_volume = volume(body.mesh->topology, body.positions);
  if (!(end_volume > 0.0)) return failure(world, body, volume_report(end_volume));
  if (end_volume > greatest_growth * least_volume) {
    return failure(world, body,
                   "its volume grew from " + text(least_volume) + " to " + text(end_volume) +
                       " m^3 in one step: the step is too long for its gas");
  }
  return std::nullopt;
}

std::optional<Divergence> integrate(const World& world, SoftBody& body, SoftState& start,
                                    IntegratorScratch& scratch) {
  start.positions = body.positions;
  start.velocities = body.velocities;
  const Settings& settings = world.settings;
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
  return check(world, body, least_volume);
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

#include <utility>

#include "sim/rigid/rigid_motion.h"
#include "sim/soft/damping.h"
#include "sim/soft/pins.h"
#include "sim/step/stages/find_divergence.h"
#include "sim/step/stages/stages.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// The state becomes the start of the step. What explicit integrators write they never read before:
/// the memory of the two states may change hands.
void hand_over(SoftBody& body, SoftState& start, bool keep) {
  if (is_still(body) && start.positions.size() == body.positions.size()) return;
  if (keep || start.positions.size() != body.positions.size()) {
    start.positions = body.positions;
    start.velocities = body.velocities;
    return;
  }
  std::swap(start.positions, body.positions);
  std::swap(start.velocities, body.velocities);
}

/// What follows the integrator's own work.
void finish(SoftBody& body, const SoftState& start, double step) {
  if (body.material.damping == Damping::literal) {
    body.velocities.rows() *= 1.0 - literal_fraction(body.material);
  }
  hold_pins(body, start, step);
}

/// From `start`, which is also in the body if the integrator is implicit.
std::optional<Divergence> integrate(const World& world, SoftBody& body, const SoftState& start,
                                    IntegratorScratch& scratch) {
  const Settings& settings = world.settings;
  const Pins* pins = body.pins.get();
  if (is_kinematic(body)) {
    hold_pins(body, start, time_step(settings));
    return std::nullopt;
  }
  double min_volume = 0.0;
  if (scratch.implicit) {
    min_volume = implicit_step(*body.mesh, body.material, settings, start, body.positions,
                               body.velocities, *scratch.implicit, pins)
                     .volume;
  } else if (pins) {
    const SoftAcceleration acceleration(*body.mesh, body.material, settings.gravity,
                                        scratch.acceleration);
    min_volume = explicit_step(settings.integrator, PinnedAcceleration(acceleration, *pins),
                               time_step(settings), start, body.positions, body.velocities,
                               scratch.explicit_step);
  } else {
    const SoftAcceleration acceleration(*body.mesh, body.material, settings.gravity,
                                        scratch.acceleration);
    min_volume = integrate(settings.integrator, acceleration, time_step(settings), start,
                           body.positions, body.velocities, scratch);
  }
  finish(body, start, time_step(settings));
  return find_divergence(world, body, start, min_volume);
}

/// Bodies that springs join. Returns the first one's failure.
std::optional<Divergence> integrate(World& world, JoinedStep& group,
                                    std::span<const SoftState> start,
                                    const std::vector<int>& mesh_of_body,
                                    std::vector<IntegratorScratch>& scratch) {
  const auto scratch_of = [&](int body) -> IntegratorScratch& {
    return scratch[at(mesh_of_body[at(body)])];
  };
  const std::vector<int>& bodies = group.bodies();
  if (bodies.size() == 1) {
    const int alone = bodies.front();
    return integrate(world, world.soft[at(alone)], start[at(alone)], scratch_of(alone));
  }
  const std::span<const double> min_volumes = group.step(world, start, scratch_of);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    SoftBody& body = world.soft[at(bodies[i])];
    const SoftState& before = start[at(bodies[i])];
    finish(body, before, time_step(world.settings));
    if (is_kinematic(world, bodies[i])) continue;
    if (auto failed = find_divergence_of_joined(world, body, before, min_volumes[i])) return failed;
  }
  return std::nullopt;
}

void integrate_groups(World& world, std::vector<SoftState>& start, IntegrateSoftMemory& memory,
                      base::Workers& workers) {
  const bool keep = is_implicit(world.settings.integrator);
  const auto block = [&](int begin, int end, int thread) {
    for (int i = begin; i < end; ++i) {
      JoinedStep& group = memory.groups[at(i)];
      for (const int body : group.bodies()) {
        hand_over(world.soft[at(body)], start[at(body)], keep || is_fixed(world, body));
      }
      const int first = group.bodies().front();
      if (is_asleep(world, first)) continue;
      memory.outcomes[at(first)] =
          integrate(world, group, start, memory.mesh_of_body, memory.scratch[at(thread)]);
    }
  };
  workers.for_blocks(static_cast<int>(memory.groups.size()), block);
}

std::optional<Divergence> integrate(const World& world, RigidBox& box) {
  const auto move = is_as_printed(world.settings) ? move_as_printed : move_freely;
  move(box, world.settings.gravity, time_step(world.settings));
  if (box.position.allFinite() && box.orientation.coeffs().allFinite() &&
      box.velocity.allFinite() && box.angular_velocity.allFinite()) {
    return std::nullopt;
  }
  return Divergence{Stage::integrate_rigid, world.steps + 1, box.name,
                    "its position, orientation or velocity is not a finite number: it was hit "
                    "too hard"};
}

}  // namespace

std::optional<Divergence> integrate_soft(World& world, std::vector<SoftState>& start,
                                         IntegrateSoftMemory& memory, base::Workers& workers) {
  const auto block = [&](int begin, int end, int thread) {
    for (int i = begin; i < end; ++i) {
      if (memory.is_driven[at(i)] != 0) continue;
      const int mesh = memory.mesh_of_body[at(i)];
      hand_over(world.soft[at(i)], start[at(i)],
                is_implicit(world.settings.integrator) || is_fixed(world, i));
      if (is_asleep(world, i)) continue;
      memory.outcomes[at(i)] =
          integrate(world, world.soft[at(i)], start[at(i)], memory.scratch[at(thread)][at(mesh)]);
    }
  };
  workers.for_blocks(memory.alone, block);
  if (!memory.groups.empty()) integrate_groups(world, start, memory, workers);
  for (const std::optional<Divergence>& outcome : memory.outcomes) {
    if (outcome) return outcome;
  }
  return std::nullopt;
}

void hold_pins(World& world, std::span<const SoftState> start, const IntegrateSoftMemory& memory) {
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    if (memory.is_driven[i] == 0) hold_pins(world.soft[i], start[i], time_step(world.settings));
  }
}

std::optional<Divergence> integrate_group_again(World& world, JoinedStep& group,
                                                std::span<const SoftState> start,
                                                IntegrateSoftMemory& memory, int thread) {
  for (const int i : group.bodies()) {
    SoftBody& moved = world.soft[at(i)];
    if (is_kinematic(world, i)) continue;
    moved.positions = start[at(i)].positions;
    moved.velocities = start[at(i)].velocities;
  }
  return integrate(world, group, start, memory.mesh_of_body, memory.scratch[at(thread)]);
}

std::optional<Divergence> integrate_soft_again(World& world, int body, const SoftState& start,
                                               IntegrateSoftMemory& memory, int thread) {
  SoftBody& moved = world.soft[at(body)];
  moved.positions = start.positions;
  moved.velocities = start.velocities;
  const int mesh = memory.mesh_of_body[at(body)];
  return integrate(world, moved, start, memory.scratch[at(thread)][at(mesh)]);
}

std::optional<Divergence> integrate_rigid(World& world, std::vector<RigidState>& start) {
  keep_rigid(world, start);
  const int soft = static_cast<int>(world.soft.size());
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    if (is_asleep(world, soft + static_cast<int>(i))) continue;
    if (auto divergence = integrate(world, world.rigid[i])) return divergence;
  }
  return std::nullopt;
}

std::optional<Divergence> integrate_rigid_again(World& world, int box, const RigidState& start) {
  RigidBox& moved = world.rigid[at(box)];
  set_state(moved, start);
  return integrate(world, moved);
}

}  // namespace pneuma::sim

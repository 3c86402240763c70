#include "sim/response/keep_volume.h"
#include "sim/response/vertex_on_ground.h"
#include "sim/soft/pressure_force.h"
#include "sim/step/find_divergence.h"
#include "sim/step/resolve_island.h"
#include "sim/step/stages.h"

namespace pneuma::sim {
namespace {

void prepare(const World& world, StepWorkspace& workspace) {
  workspace.islands.divide(workspace.contacts);
  workspace.box_masses.clear();
  for (const RigidBox& box : world.rigid) workspace.box_masses.push_back(box_mass(box));
  const std::size_t count = workspace.islands.ordered().size();
  if (workspace.impulses.size() < count) {
    workspace.impulses.resize(count);
    workspace.pair_work.resize(count);
  }
}

void resolve_alone(World& world, const StepWorkspace& workspace, int number) {
  const Contact& contact = workspace.contacts[at(workspace.islands.alone()[at(number)])];
  SoftBody& body = world.soft[at(contact.first.body)];
  const SoftState& start = workspace.soft_start[at(contact.first.body)];
  const int v = contact.first.feature.index;
  const Surface pair = combine(body.material.surface, *world.settings.ground);
  Vec3 velocity = body.velocities[v];
  const bool sticks = meet_ground(-start.velocities[v].z(), pair, velocity);
  body.velocities[v] = velocity;
  put_onto_ground(world, workspace, contact, sticks);
}

/// No island touches what another does.
void resolve_all(World& world, StepWorkspace& workspace) {
  const auto alone = [&world, &workspace](int begin, int end, int) {
    for (int i = begin; i < end; ++i) resolve_alone(world, workspace, i);
  };
  workspace.workers.for_blocks(static_cast<int>(workspace.islands.alone().size()), alone);
  const auto islands = [&world, &workspace](int begin, int end, int) {
    for (int i = begin; i < end; ++i) resolve_island(world, workspace, i);
  };
  workspace.workers.for_blocks(workspace.islands.count(), islands);
}

void keep_positions(const World& world, StepWorkspace& workspace) {
  workspace.before_contacts.resize(world.soft.size());
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    workspace.before_contacts[i] = world.soft[i].positions;
  }
}

/// What an implicit integrator promises, contacts keep: a body that holds gas has a volume.
void keep_volumes(World& world, const StepWorkspace& workspace) {
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    SoftBody& body = world.soft[i];
    if (gas_strength(body.material) == 0.0) continue;
    keep_volume(body.mesh->topology, workspace.before_contacts[i], body.positions);
  }
}

/// In the order in which the contacts were found, whichever islands they are in.
void remember(World& world, StepWorkspace& workspace) {
  world.resting_impulses.clear();
  if (world.rigid.empty()) return;
  const std::span<const int> ordered = workspace.islands.ordered();
  std::vector<int>& number = workspace.impulse_number;
  number.resize(workspace.contacts.size());
  for (std::size_t i = 0; i < ordered.size(); ++i) number[at(ordered[i])] = static_cast<int>(i);
  for (std::size_t i = 0; i < workspace.contacts.size(); ++i) {
    const Contact& contact = workspace.contacts[i];
    if (!is_rigid(contact)) continue;
    const int second = contact.second.kind == BodyKind::ground ? -1 : contact.second.body;
    world.resting_impulses.push_back({contact.first.body, second, place_on_first(world, contact),
                                      workspace.impulses[at(number[i])].total()});
  }
}

/// The last look at a step: the first of all bodies.
std::optional<Divergence> find_first_divergence(const World& world, StepWorkspace& workspace) {
  const auto block = [&world, &workspace](int begin, int end, int) {
    for (int i = begin; i < end; ++i) {
      workspace.soft_outcome[at(i)] = find_divergence(world, world.soft[at(i)]);
    }
  };
  workspace.workers.for_blocks(static_cast<int>(world.soft.size()), block);
  for (const std::optional<Divergence>& outcome : workspace.soft_outcome) {
    if (outcome) return outcome;
  }
  for (const RigidBox& box : world.rigid) {
    if (auto divergence = find_divergence(world, box)) return divergence;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Divergence> resolve_contacts(World& world, StepWorkspace& workspace) {
  if (workspace.contacts.empty()) {
    world.resting_impulses.clear();
    return std::nullopt;
  }
  const bool keeps_volume = is_implicit(world.settings.integrator);
  if (keeps_volume) keep_positions(world, workspace);
  prepare(world, workspace);
  resolve_all(world, workspace);
  if (keeps_volume) keep_volumes(world, workspace);
  if (auto divergence = find_first_divergence(world, workspace)) return divergence;
  remember(world, workspace);
  return std::nullopt;
}

}  // namespace pneuma::sim

#include <limits>

#include "sim/response/depenetrate_pairs.h"
#include "sim/response/ground_contact.h"
#include "sim/response/printed_response.h"
#include "sim/step/stages/find_divergence.h"
#include "sim/step/stages/resolve_island.h"
#include "sim/step/stages/stages.h"

namespace pneuma::sim {
namespace {

void prepare(const World& world, std::span<const Contact> contacts, ResolveContactsMemory& memory) {
  memory.islands.divide(contacts);
  memory.box_masses.clear();
  for (const RigidBox& box : world.rigid) memory.box_masses.push_back(box_mass(box));
  const std::size_t count = memory.islands.ordered().size();
  if (memory.impulses.size() < count) {
    memory.impulses.resize(count);
    memory.pair_work.resize(count);
  }
}

/// No island touches what another does.
void resolve_all(World& world, const MotionStart& start, std::span<Contact> contacts,
                 ResolveContactsMemory& memory, base::Workers& workers) {
  const std::span<const int> alone = memory.islands.alone();
  workers.for_blocks(static_cast<int>(alone.size()), [&](int begin, int end, int) {
    for (int i = begin; i < end; ++i) {
      Contact& contact = contacts[at(alone[at(i)])];
      resolve_alone(world, start.soft[at(contact.first.body)], contact);
    }
  });
  workers.for_blocks(memory.islands.count(), [&](int begin, int end, int) {
    for (int i = begin; i < end; ++i) resolve_island(world, start, contacts, i, memory);
  });
  const std::span<const int> ordered = memory.islands.ordered();
  for (std::size_t i = 0; i < ordered.size(); ++i) {
    contacts[at(ordered[i])].impulse = memory.impulses[i].total();
  }
}

void keep_positions(const World& world, std::vector<VertexArray>& before_contacts) {
  before_contacts.resize(world.soft.size());
  for (std::size_t i = 0; i < world.soft.size(); ++i) before_contacts[i] = world.soft[i].positions;
}

void keep_volumes(World& world, const std::vector<VertexArray>& before_contacts) {
  for (std::size_t i = 0; i < world.soft.size(); ++i)
    keep_volume(world.soft[i], before_contacts[i]);
}

/// In the order in which the contacts were found, whichever islands they are in.
void remember(World& world, std::span<const Contact> contacts, ResolveContactsMemory& memory) {
  world.warm_start_impulses.clear();
  if (world.rigid.empty()) return;
  const std::span<const int> ordered = memory.islands.ordered();
  std::vector<int>& number = memory.impulse_number;
  number.resize(contacts.size());
  for (std::size_t i = 0; i < ordered.size(); ++i) number[at(ordered[i])] = static_cast<int>(i);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    if (!is_rigid(contact)) continue;
    const int second = contact.second.kind == SideKind::ground ? -1 : contact.second.body;
    world.warm_start_impulses.push_back({contact.first.body, second, point_on_first(world, contact),
                                         memory.impulses[at(number[i])].total()});
  }
}

/// In the order in which they were found, by one thread: each changes what the next one meets.
std::optional<Divergence> resolve_as_printed(World& world, std::span<Contact> contacts,
                                             ResolveContactsMemory& memory,
                                             base::Workers& workers) {
  memory.box_masses.clear();
  memory.box_positions.clear();
  for (const RigidBox& box : world.rigid) {
    memory.box_masses.push_back(box_mass(box));
    memory.box_positions.push_back(box.position);
  }
  apply_printed_impulses(world, memory.box_masses, contacts);
  separate_as_printed(world, memory.box_positions, contacts);
  return find_first_divergence(world, memory.outcomes, workers);
}

/// A body moves by its own radius in the time in which surfaces part by a factor of e.
double radii_in_a_step(const Settings& settings) {
  if (settings.relaxation_time == 0.0) return std::numeric_limits<double>::infinity();
  return time_step(settings) / settings.relaxation_time;
}

}  // namespace

std::optional<Divergence> resolve_contacts(World& world, const MotionStart& start,
                                           std::span<Contact> contacts,
                                           ResolveContactsMemory& memory, base::Workers& workers) {
  if (contacts.empty()) {
    world.warm_start_impulses.clear();
    return std::nullopt;
  }
  if (is_as_printed(world.settings)) return resolve_as_printed(world, contacts, memory, workers);
  if (world.settings.contact == ContactMethod::swept) {  // a soft body on the ground, nothing else
    memory.before_contacts.resize(1);
    resolve_on_ground(world, 0, start.soft.front(), contacts, memory.before_contacts.front());
    return find_first_divergence(world, memory.outcomes, workers);
  }
  const bool keeps_volume = is_implicit(world.settings.integrator);
  if (keeps_volume) keep_positions(world, memory.before_contacts);
  prepare(world, contacts, memory);
  resolve_all(world, start, contacts, memory, workers);
  if (keeps_volume) keep_volumes(world, memory.before_contacts);
  if (auto divergence = find_first_divergence(world, memory.outcomes, workers)) return divergence;
  remember(world, contacts, memory);
  return std::nullopt;
}

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

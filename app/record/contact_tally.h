// Counts contacts over the steps of a run.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "sim/collision/contact.h"
#include "sim/step/stages/plan.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// Which of the plan's kinds a contact is.
sim::ContactKind kind_of(const sim::Contact& contact);

/// How many there are of each kind, by its number.
using ContactCounts = std::array<std::int64_t, sim::contact_kind_count>;
ContactCounts count_by_kind(std::span<const sim::Contact> contacts);

/// How many of the soft_soft ones are with a static or moved mesh, which a world has among its soft
/// bodies.
std::int64_t count_with_obstacles(std::span<const sim::Contact> contacts, const sim::World& world);

struct ContactTally {
  struct Count {
    std::int64_t sum = 0;
    std::int64_t most = 0;  // in one step
  };

  std::int64_t steps = 0;
  std::int64_t touching_steps = 0;  // steps in which two bodies touched; the ground does not count
  Count all;
  std::array<Count, sim::contact_kind_count> by_kind;
  Count with_obstacles;  // of soft bodies and static or moved meshes: they are none of by_kind's

  /// The contacts of one step, `obstacle_contacts` of which are what count_with_obstacles says.
  void add(std::span<const sim::Contact> contacts, std::int64_t obstacle_contacts = 0);

  /// Per step; 0 before the first.
  double mean(const Count& count) const;
  double mean_between_bodies() const;
  double touching_share() const;

  const Count& of(sim::ContactKind kind) const { return by_kind[static_cast<std::size_t>(kind)]; }
};

/// Mean and maximum per step, of each kind and of all.
nlohmann::json contacts_per_step_json(const ContactTally& contacts);

}  // namespace pneuma::app

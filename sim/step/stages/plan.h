// The stages of a step in execution order, and which of them a given world needs.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "sim/world/world.h"

namespace pneuma::sim {

/// One word per stage: the same in the enum, the function, the file and the profile.
enum class Stage {
  integrate_soft,
  integrate_rigid,
  broad_phase,
  move_particles,
  find_contacts,
  resolve_contacts,
  depenetrate,
};
inline constexpr int stage_count = static_cast<int>(Stage::depenetrate) + 1;  // the last
std::string_view to_string(Stage stage);

/// The kinds of contact that find_contacts looks for.
enum class ContactKind { soft_ground, rigid_ground, soft_soft, soft_rigid, rigid_rigid };
inline constexpr int contact_kind_count = 5;
std::string_view to_string(ContactKind kind);

/// What a step of one world does. Made once per world, from what is in it.
struct Plan {
  struct Item {
    bool runs = true;
    std::string reason;  // why it is left out; empty when it runs
  };
  std::array<Item, stage_count> stages;
  std::array<Item, contact_kind_count> contact_kinds;

  bool runs(Stage stage) const { return stages[static_cast<std::size_t>(stage)].runs; }
  bool runs(ContactKind kind) const { return contact_kinds[static_cast<std::size_t>(kind)].runs; }
};

Plan make_plan(const World& world);

/// The plan that leaves nothing out: what tests compare a world's own plan with.
Plan make_full_plan();

}  // namespace pneuma::sim

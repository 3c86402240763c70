#include "sim/step/plan.h"

#include <algorithm>

#include "sim/collision/deep_pair.h"
#include "sim/soft/damping.h"

namespace pneuma::sim {
namespace {

using Item = Plan::Item;

Item needs(bool condition, const char* reason) {
  return condition ? Item{true, {}} : Item{false, reason};
}

Item& item(Plan& plan, Stage stage) { return plan.stages[static_cast<std::size_t>(stage)]; }
Item& item(Plan& plan, ContactKind kind) {
  return plan.contact_kinds[static_cast<std::size_t>(kind)];
}

}  // namespace

std::string_view to_string(Stage stage) {
  switch (stage) {
    case Stage::integrate_soft:
      return "integrate_soft";
    case Stage::integrate_rigid:
      return "integrate_rigid";
    case Stage::find_pairs:
      return "find_pairs";
    case Stage::move_particles:
      return "move_particles";
    case Stage::find_contacts:
      return "find_contacts";
    case Stage::resolve_contacts:
      return "resolve_contacts";
    case Stage::part_bodies:
      break;
  }
  return "part_bodies";
}

std::string_view to_string(ContactKind kind) {
  switch (kind) {
    case ContactKind::soft_ground:
      return "soft_ground";
    case ContactKind::rigid_ground:
      return "rigid_ground";
    case ContactKind::soft_soft:
      return "soft_soft";
    case ContactKind::soft_rigid:
      return "soft_rigid";
    case ContactKind::rigid_rigid:
      break;
  }
  return "rigid_rigid";
}

Plan make_plan(const World& world) {
  const std::size_t soft = world.soft.size(), rigid = world.rigid.size();
  const bool ground = world.settings.ground.has_value();
  Plan plan;

  item(plan, Stage::integrate_soft) = needs(soft > 0, "no soft body");
  item(plan, Stage::integrate_rigid) = needs(rigid > 0, "no rigid box");
  item(plan, Stage::find_pairs) = needs(soft + rigid > 1, "a single body has no pair");
  item(plan, Stage::move_particles) = needs(soft > 1, "particles need two soft bodies");
  if (soft > 1 && world.settings.soft_search == SoftSearch::exact) {
    item(plan, Stage::move_particles) = {false, "the search for soft contacts is exact"};
  }
  const bool contacts = ground || soft + rigid > 1;
  item(plan, Stage::find_contacts) =
      needs(contacts, "a single body without a ground touches nothing");
  item(plan, Stage::resolve_contacts) = item(plan, Stage::find_contacts);

  const char* no_ground = "no ground";
  item(plan, ContactKind::soft_ground) =
      needs(ground && soft > 0, ground ? "no soft body" : no_ground);
  item(plan, ContactKind::rigid_ground) =
      needs(ground && rigid > 0, ground ? "no rigid box" : no_ground);
  item(plan, ContactKind::soft_soft) = needs(soft > 1, "fewer than two soft bodies");
  item(plan, ContactKind::soft_rigid) = needs(soft > 0 && rigid > 0, "not both soft and rigid");
  item(plan, ContactKind::rigid_rigid) = needs(rigid > 1, "fewer than two rigid boxes");

  const auto filled = std::ranges::count_if(
      world.soft, [](const SoftBody& body) { return has_filled_centre(*body.mesh); });
  item(plan, Stage::part_bodies) =
      needs(filled > 1, "fewer than two soft bodies that are filled at their centre");

  bool valence = false, dashpots = false;
  for (const SoftBody& body : world.soft) {
    valence |= body.material.pressure == PressureWeighting::valence;
    dashpots |= dashpot_constant(body.material) > 0.0;
  }
  plan.valence_weights = needs(valence, "every body's pressure is uniform");
  plan.spring_damping = needs(dashpots, "no body has dashpots");
  return plan;
}

Plan make_full_plan() { return {}; }

}  // namespace pneuma::sim

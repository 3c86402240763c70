#include "sim/step/stages/plan.h"

#include <algorithm>

#include "sim/base/enum_name.h"
#include "sim/collision/overlapping_pair.h"

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

void leave_out_what_swept_contacts_do(bool shows_particles, Plan& plan) {
  const auto leave_out = [&](Stage stage, const char* reason) {
    if (plan.runs(stage)) item(plan, stage) = {false, reason};
  };
  if (!(shows_particles && plan.runs(Stage::move_particles))) {
    leave_out(Stage::broad_phase, "swept contacts are found over the whole step");
    leave_out(Stage::move_particles, "swept contacts are found by bounding hierarchies");
  }
  leave_out(Stage::depenetrate, "swept soft bodies do not overlap");
}

void leave_out_what_the_potential_does(bool shows_particles, Plan& plan) {
  for (const Stage stage : {Stage::broad_phase, Stage::move_particles, Stage::find_contacts,
                            Stage::resolve_contacts, Stage::depenetrate}) {
    const bool is_shown =
        shows_particles && (stage == Stage::broad_phase || stage == Stage::move_particles);
    if (is_shown || !plan.runs(stage)) continue;
    item(plan, stage) = {false, "contact is a term of the equation that integrate_soft solves"};
  }
}

}  // namespace

std::string_view to_string(Stage stage) {
  static constexpr auto names = std::to_array<std::string_view>(
      {"integrate_soft", "integrate_rigid", "broad_phase", "move_particles", "find_contacts",
       "resolve_contacts", "depenetrate"});
  static_assert(names.size() == stage_count);
  return base::enum_name(names, stage);
}

std::string_view to_string(ContactKind kind) {
  static constexpr auto names = std::to_array<std::string_view>(
      {"soft_ground", "rigid_ground", "soft_soft", "soft_rigid", "rigid_rigid"});
  static_assert(names.size() == contact_kind_count);
  return base::enum_name(names, kind);
}

Plan make_plan(const World& world) {
  const std::size_t soft = world.soft.size(), rigid = world.rigid.size();
  const bool free_boxes = !std::ranges::all_of(world.rigid, &RigidBox::is_kinematic);
  const bool ground = world.settings.ground.has_value();
  Plan plan;

  // Where contact is a potential, free boxes are part of the same equation.
  const bool with_boxes = world.settings.contact == ContactMethod::potential && free_boxes;
  item(plan, Stage::integrate_soft) = needs(soft > 0 || with_boxes, "no soft body");
  item(plan, Stage::integrate_rigid) = needs(rigid > 0, "no rigid box");
  item(plan, Stage::broad_phase) = needs(soft + rigid > 1, "a single body has no pair");
  item(plan, Stage::move_particles) = needs(soft > 1, "particles need two soft bodies");
  if (soft > 1 && world.settings.soft_search == SoftSearch::exact) {
    item(plan, Stage::move_particles) = {false, "the search for soft contacts is exact"};
  }
  const bool contacts = ground || soft + rigid > 1;
  item(plan, Stage::find_contacts) =
      needs(contacts, "a single body without a ground touches nothing");
  item(plan, Stage::resolve_contacts) = item(plan, Stage::find_contacts);

  const char* no_ground = "no ground";
  const char* no_free_box = rigid > 0 ? "every box is static or moved" : "no rigid box";
  item(plan, ContactKind::soft_ground) =
      needs(ground && soft > 0, ground ? "no soft body" : no_ground);
  item(plan, ContactKind::rigid_ground) =
      needs(ground && free_boxes, ground ? no_free_box : no_ground);
  item(plan, ContactKind::soft_soft) = needs(soft > 1, "fewer than two soft bodies");
  item(plan, ContactKind::soft_rigid) = needs(soft > 0 && rigid > 0, "not both soft and rigid");
  item(plan, ContactKind::rigid_rigid) =
      needs(rigid > 1 && free_boxes, rigid > 1 ? no_free_box : "fewer than two rigid boxes");

  const auto filled = std::ranges::count_if(
      world.soft, [](const SoftBody& body) { return has_filled_centre(*body.mesh); });
  item(plan, Stage::depenetrate) =
      needs(filled > 1, "fewer than two soft bodies that are filled at their centre");
  if (is_as_printed(world.settings)) {
    item(plan, Stage::depenetrate) = {false, "the paper moves features apart, not whole bodies"};
  }
  if (world.settings.contact == ContactMethod::swept) {
    leave_out_what_swept_contacts_do(world.settings.particles.shown, plan);
  }
  if (world.settings.contact == ContactMethod::potential) {
    leave_out_what_the_potential_does(
        world.settings.particles.shown && plan.runs(Stage::move_particles), plan);
  }
  return plan;
}

Plan make_full_plan() { return {}; }

}  // namespace pneuma::sim

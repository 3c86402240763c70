#include "sim/step/stepper.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "sim/inspect/inspect.h"
#include "sim/joints/body_springs.h"
#include "sim/rigid/given_motion.h"
#include "sim/rigid/rigid_motion.h"
#include "sim/soft/pins.h"
#include "sim/step/stage_runner.h"
#include "sim/step/stages/stages.h"
#include "sim/step/swept/swept_warm_start.h"
#include "sim/step/swept_step.h"

namespace pneuma::sim {
namespace {

/// Takes back what the stages up to the one that failed have done.
void restore(World& world, const StepWorkspace& workspace, Stage failed) {
  const MotionStart& motion = workspace.motion_start;
  restore_soft(world, motion.soft);
  if (failed == Stage::integrate_soft) return;
  restore_rigid(world, motion.rigid);
  if (failed == Stage::integrate_rigid || !workspace.plan.runs(Stage::broad_phase)) return;
  world.particles = workspace.pair_start.particles;
  world.depenetrating = workspace.pair_start.depenetrating;
  world.warm_start_impulses = workspace.pair_start.warm_start_impulses;
}

/// A soft body on the ground needs no sweep: its vertices meet the ground each for itself.
bool may_touch_more_than_ground(const Plan& plan) {
  return plan.runs(Stage::resolve_contacts) &&
         (plan.runs(ContactKind::rigid_ground) || plan.runs(ContactKind::soft_soft) ||
          plan.runs(ContactKind::soft_rigid) || plan.runs(ContactKind::rigid_rigid));
}

/// Where contacts are swept: what touches nothing moves as swept_step would move it.
bool touches_nothing(const World& world, const Plan& plan) {
  return world.settings.contact == ContactMethod::swept && !plan.runs(Stage::resolve_contacts);
}

void let_fall(World& world, const std::vector<RigidState>& start) {
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    RigidBox& box = world.rigid[i];
    if (!box.is_kinematic) box.position += missing_fall(box, start[i], time_step(world.settings));
  }
}

/// Per body: whether it is an obstacle whose vertices nothing in a step needs to find in the world,
/// as swept contacts place those that they reach.
std::vector<std::uint8_t> find_driven(const World& world, const StepWorkspace& w) {
  std::vector<std::uint8_t> is_driven(world.soft.size());
  if (!w.swept || !world.springs.empty() || w.options.after_part ||
      world.settings.particles.shown) {
    return is_driven;
  }
  for (std::size_t i = 0; i < is_driven.size(); ++i) {
    is_driven[i] = keeps_shape(world.soft[i]) && !is_still(world.soft[i]) ? 1 : 0;
  }
  return is_driven;
}

void aim_pins(World& world, std::span<const std::uint8_t> is_driven) {
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    if (is_driven[i] == 0) aim_pins(world.soft[i], world.settings, world.steps);
  }
}

/// At the end of a step.
void place_pins(World& world, StepWorkspace& w) {
  for (int i = 0; i < soft_count(world); ++i) {
    SoftBody& body = world.soft[at(i)];
    if (w.integrate_soft.is_driven[at(i)] == 0) {
      place_pins(body, time(world));
    } else {
      w.swept->bodies.end_step(body, i, w.options.may_leave_obstacles);
    }
  }
}

/// Particles that nothing depends on.
void walk_to_be_shown(World& world, StepWorkspace& w) {
  const StageRunner run(w);
  run(Stage::broad_phase,
      [&] { broad_phase(world, w.plan, w.pair_start, w.near_bodies, w.broad_phase, w.workers); });
  run(Stage::move_particles,
      [&] { move_particles(world, w.near_bodies, w.move_particles, w.workers); });
}

double energy_if(bool is_measured, const World& world) {
  return is_measured ? energy(world).total() : 0.0;
}

}  // namespace

IntegrateSoftMemory::IntegrateSoftMemory(const World& world, int threads)
    : scratch(at(threads)), outcomes(world.soft.size()) {
  std::map<const SoftMesh*, int> known;
  for (const SoftBody& body : world.soft) {
    if (!can_integrate(world.settings.integrator, body.material)) {
      throw std::invalid_argument(body.name +
                                  ": implicit integrators cannot step valence pressure");
    }
    const auto [entry, is_new] = known.try_emplace(body.mesh.get(), static_cast<int>(known.size()));
    if (is_new) {
      for (auto& meshes : scratch) meshes.emplace_back(*body.mesh, world.settings.integrator);
    }
    mesh_of_body.push_back(entry->second);
  }
  if (world.springs.empty()) {
    alone = static_cast<int>(world.soft.size());
  } else {
    for (std::vector<int>& bodies : joined_bodies(world)) groups.emplace_back(world, bodies);
  }
}

BroadPhaseMemory::BroadPhaseMemory(const World& world, bool depenetrates) {
  if (!depenetrates) return;
  for (const SoftBody& body : world.soft) {
    has_filled_centre.push_back(sim::has_filled_centre(*body.mesh) ? 1 : 0);
  }
}

FindContactsMemory::FindContactsMemory(int threads)
    : soft_soft(at(threads)), exact(at(threads)), columns(at(threads)), found(at(threads - 1)) {}

ResolveContactsMemory::ResolveContactsMemory(const World& world)
    : islands(world), outcomes(world.soft.size()) {}

StepWorkspace::StepWorkspace(const World& world, StepperOptions given)
    : options(std::move(given)),
      plan(options.plan ? *options.plan : make_plan(world)),
      workers(options.threads),
      has_given_motions(
          std::ranges::any_of(world.rigid,
                              [](const RigidBox& box) { return box.motion != nullptr; }) ||
          std::ranges::any_of(
              world.soft, [](const SoftBody& body) { return body.pins && body.pins->are_moved; })),
      has_inputs(has_given_motions || has_gas_flow(world)),
      has_pins(std::ranges::any_of(world.soft,
                                   [](const SoftBody& body) { return body.pins != nullptr; })),
      motion_start{std::vector<SoftState>(world.soft.size()),
                   std::vector<RigidState>(world.rigid.size())},
      integrate_soft(world, options.threads),
      broad_phase(world, plan.runs(Stage::depenetrate)),
      move_particles{std::vector<ParticleScratch>(at(options.threads))},
      find_contacts(options.threads),
      resolve_contacts(world) {
  if (world.settings.contact == ContactMethod::swept && may_touch_more_than_ground(plan)) {
    swept.emplace(world);
    swept->measures_work = options.measure_work;
  }
  if (world.settings.contact == ContactMethod::swept && !swept &&
      plan.runs(Stage::resolve_contacts)) {
    fall_asleep.emplace(world);
  }
  if (has_gas_flow(world)) gas_flow.emplace(world);
  if (world.settings.contact == ContactMethod::potential && plan.runs(Stage::integrate_soft)) {
    potential = std::make_unique<PotentialMemory>(world);
  }
  integrate_soft.is_driven = find_driven(world, *this);
  if (swept) swept->bodies.leave_in_place(integrate_soft.is_driven);
}

Stepper::Stepper(const World& world, StepperOptions options)
    : workspace_(std::make_unique<StepWorkspace>(world, std::move(options))) {}
Stepper::~Stepper() = default;
Stepper::Stepper(Stepper&&) noexcept = default;
Stepper& Stepper::operator=(Stepper&&) noexcept = default;

std::optional<Divergence> Stepper::step(World& world) {
  if (!workspace_->has_inputs) return step_bodies(world);
  std::optional<GasFlow>& gas_flow = workspace_->gas_flow;
  if (gas_flow) gas_flow->begin_step(world);
  if (workspace_->has_given_motions) {
    aim_given_motions(world);
    aim_pins(world, workspace_->integrate_soft.is_driven);
  }
  if (auto divergence = step_bodies(world)) {
    if (gas_flow) gas_flow->take_back(world);
    return divergence;
  }
  if (workspace_->has_given_motions) {
    place_given_motions(world, time(world));
    place_pins(world, *workspace_);
  }
  if (gas_flow) gas_flow->end_step(world);
  return std::nullopt;
}

std::optional<Divergence> Stepper::step_bodies(World& world) {
  StepWorkspace& w = *workspace_;
  if (w.swept) return step_swept(world);
  if (w.potential) return step_by_potential(world);
  return w.fall_asleep ? step_on_ground(world) : step_in_stages(world);
}

/// It sleeps as what is swept does.
std::optional<Divergence> Stepper::step_on_ground(World& world) {
  StepWorkspace& w = *workspace_;
  forget_other_bodies(world);
  wake_moving(world);
  if (is_at_rest(world)) {
    w.contacts.clear();
    w.contact_work = 0.0;
    ++world.steps;
    return std::nullopt;
  }
  if (auto divergence = step_in_stages(world)) return divergence;
  if (w.fall_asleep->count_quiet_steps(world, w.motion_start)) {
    w.contact_work -= w.fall_asleep->put_to_sleep(world, {}, w.contacts);
  }
  return std::nullopt;
}

std::optional<Divergence> Stepper::step_in_stages(World& world) {
  StepWorkspace& w = *workspace_;
  const StageRunner run(w);
  std::optional<Divergence> divergence;

  run(Stage::integrate_soft, [&] {
    divergence = integrate_soft(world, w.motion_start.soft, w.integrate_soft, w.workers);
  });
  if (!divergence) {
    run(Stage::integrate_rigid, [&] {
      divergence = integrate_rigid(world, w.motion_start.rigid);
      if (!divergence && touches_nothing(world, w.plan)) let_fall(world, w.motion_start.rigid);
    });
  }
  const double before_contacts = energy_if(w.options.measure_work, world);
  if (!divergence) {
    run(Stage::broad_phase,
        [&] { broad_phase(world, w.plan, w.pair_start, w.near_bodies, w.broad_phase, w.workers); });
    run(Stage::move_particles,
        [&] { move_particles(world, w.near_bodies, w.move_particles, w.workers); });
    run(Stage::find_contacts, [&] {
      find_contacts(world, w.plan, w.near_bodies, w.contacts, w.find_contacts, w.workers);
    });
    run(Stage::resolve_contacts, [&] {
      divergence =
          resolve_contacts(world, w.motion_start, w.contacts, w.resolve_contacts, w.workers);
    });
  }
  if (!divergence) {
    run(Stage::depenetrate, [&] { divergence = depenetrate(world, w.near_bodies, w.depenetrate); });
  }
  if (divergence) {
    restore(world, w, divergence->stage);
    return divergence;
  }
  if (w.has_pins) hold_pins(world, w.motion_start.soft, w.integrate_soft);
  w.contact_work = energy_if(w.options.measure_work, world) - before_contacts;
  if (w.options.after_part) w.options.after_part(world);

  ++world.steps;
  return std::nullopt;
}

std::optional<Divergence> Stepper::step_swept(World& world) {
  StepWorkspace& w = *workspace_;
  if (auto divergence = swept_step(world, w)) return divergence;
  if (world.settings.particles.shown) walk_to_be_shown(world, w);
  ++world.steps;
  return std::nullopt;
}

std::optional<Divergence> Stepper::step_by_potential(World& world) {
  StepWorkspace& w = *workspace_;
  if (auto divergence = potential_step(world, w)) return divergence;
  if (world.settings.particles.shown) walk_to_be_shown(world, w);
  ++world.steps;
  return std::nullopt;
}

void Stepper::place_obstacles(World& world) {
  if (workspace_->swept) workspace_->swept->bodies.place_left_behind(world);
}

double Stepper::contact_work() const {
  const StepWorkspace& w = *workspace_;
  if (!w.options.measure_work) return 0.0;
  return w.swept ? w.swept->work : w.contact_work;
}
double Stepper::driven_work() const {
  if (workspace_->potential) return workspace_->potential->driven_work;
  return workspace_->swept ? workspace_->swept->driven_work : 0.0;
}
double Stepper::gas_work() const {
  return workspace_->gas_flow ? workspace_->gas_flow->work() : 0.0;
}
const Plan& Stepper::plan() const { return workspace_->plan; }
std::span<const Contact> Stepper::contacts() const { return workspace_->contacts; }
const StageTimes& Stepper::stage_times() const { return workspace_->stage_times; }

}  // namespace pneuma::sim

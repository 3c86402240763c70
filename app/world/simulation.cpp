#include "app/world/simulation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "app/world/build_world.h"
#include "app/world/step_advice.h"
#include "app/world/touch.h"
#include "sim/inspect/closed_surface.h"

namespace pneuma::app {
namespace {

/// Metres. A run of twenty minutes can fall 7e6 m. Further away there is nothing left to see:
/// pictures are made of single-precision numbers, which are whole metres apart there.
constexpr double farthest = 1e8;

/// Whether the step has been tried again in ever smaller parts by itself: what swept contacts
/// cannot resolve, no step can.
bool shorter_steps_failed(const sim::World& world, const sim::Divergence& divergence) {
  return world.settings.contact == sim::ContactMethod::swept &&
         divergence.stage == sim::Stage::resolve_contacts;
}

/// None for a box, for an implicit integrator, whose steps are too long for springs between bodies
/// alone, and where shorter steps have failed.
std::optional<StepAdvice> advice_for(const sim::World& world, const sim::Divergence& divergence) {
  if (shorter_steps_failed(world, divergence)) return std::nullopt;
  for (const sim::SoftBody& body : world.soft) {
    if (body.name != divergence.body) continue;
    const StepAdvice advice = step_advice_in_contact(world, body);
    if (!sim::is_implicit(world.settings.integrator) || advice.too_long()) return advice;
  }
  return std::nullopt;
}

std::string cause_and_remedy(const StepAdvice& advice) {
  const std::string cause =
      advice.too_long()
          ? fmt::format("the step of {:.3g} s is too long: {} stay stable up to {:.3g} s",
                        advice.step,
                        advice.of_contact ? "small motions of what touches" : "its small motions",
                        advice.limit)
          : fmt::format(
                "the step of {:.3g} s would do for small motions, but it was hit, "
                "stretched or pressed too hard for it",
                advice.step);
  return fmt::format(". Likely {}. Use {}", cause, remedy(advice));
}

/// "; near it are left, right and the ground", but for what the divergence names already; empty for
/// a body that is near nothing else, or not named.
std::string what_is_near(const sim::World& world, const sim::Divergence& divergence) {
  const int count = static_cast<int>(world.soft.size() + world.rigid.size());
  int body = 0;
  while (body < count && sim::body_name(world, body) != divergence.body) ++body;
  if (body == count) return "";
  const sim::Bounds own = body_bounds(world, body);
  const double reach = 0.02 * own.size().norm();
  std::vector<std::string> near;
  for (int other = 0; other < count; ++other) {
    const sim::Bounds bounds = body_bounds(world, other);
    const bool is_apart = ((bounds.low - own.high).array() > reach).any() ||
                          ((own.low - bounds.high).array() > reach).any();
    if (other != body && !is_apart) near.push_back(sim::body_name(world, other));
  }
  if (world.settings.ground && own.low.z() < reach) near.emplace_back("the ground");
  std::erase(near, divergence.other);
  if (near.empty()) return "";
  constexpr std::size_t most_named = 4;
  if (near.size() > most_named) {
    const std::size_t others = near.size() - (most_named - 1);
    near.resize(most_named - 1);
    near.push_back(fmt::format("{} others", others));
  }
  const std::string last = near.back();
  near.pop_back();
  if (near.empty()) return "; near it is " + last;
  return fmt::format("; near it are {} and {}", fmt::join(near, ", "), last);
}

/// "ball is crushed between left and right"; empty where nothing is known to be.
std::string what_is_crushed(const sim::World& world, const sim::Divergence& divergence) {
  const bool are_one = world.settings.contact == sim::ContactMethod::potential;
  return crushed_between(world, divergence.body, are_one);
}

sim::StageTimes sum(sim::StageTimes times, const sim::StageTimes& others) {
  std::ranges::transform(times, others, times.begin(), std::plus{});
  return times;
}

/// No step helps a body that has no room, and after parts of the step no shorter one of that size.
std::string what_to_do(const sim::World& world, const sim::Divergence& divergence,
                       const std::optional<StepAdvice>& advice, const std::string& crushed,
                       bool tried_parts) {
  if (!crushed.empty()) {
    return fmt::format(". {}: let what is moved stop earlier, so that it leaves it room", crushed);
  }
  const bool names_shorter_step = sim::is_implicit(world.settings.integrator);
  const bool has_remedy = !divergence.remedy.empty() && !(tried_parts && names_shorter_step);
  return (has_remedy ? "; " + divergence.remedy : "") + (advice ? cause_and_remedy(*advice) : "");
}

}  // namespace

DivergenceError divergence_error(const std::string& scene_name, const sim::Divergence& divergence,
                                 const sim::World& world, bool tried_parts) {
  const double time = static_cast<double>(divergence.step) * sim::time_step(world.settings);
  const std::string crushed = what_is_crushed(world, divergence);
  const std::optional<StepAdvice> advice =
      crushed.empty() ? advice_for(world, divergence) : std::nullopt;
  DivergenceError error(fmt::format("{}: step {} (t = {:.4f} s), {}: body {}: {}{}{}", scene_name,
                                    divergence.step, time, sim::to_string(divergence.stage),
                                    divergence.body, divergence.what,
                                    what_is_near(world, divergence),
                                    what_to_do(world, divergence, advice, crushed, tried_parts)));
  error.is_crushed = !crushed.empty();
  error.is_of_contact = divergence.stage == sim::Stage::resolve_contacts;
  error.has_no_room = divergence.stage == sim::Stage::find_contacts;
  if (advice && advice->too_long()) error.steps_per_second = advice->steps_per_second;
  return error;
}

Simulation::Simulation(const scenes::Scene& scene, sim::World world, int threads,
                       OnDivergence on_divergence)
    : scene_(scene),
      threads_(threads),
      on_divergence_(on_divergence),
      steps_per_frame_(scenes::steps_per_frame(scene)),
      world_(std::move(world)),
      stepper_(world_,
               {.threads = threads, .profile = true, .plan = {}, .may_leave_obstacles = true}) {}

void Simulation::advance_frame() {
  step_parts_.clear();
  const sim::StageTimes before = sum(stepper_.stage_times(), times_of_parts_);
  do step();
  while (world_.steps % steps_per_frame_ != 0);
  stepper_.place_obstacles(world_);
  require_all_near();
  std::ranges::transform(sum(stepper_.stage_times(), times_of_parts_), before, stage_times_.begin(),
                         std::minus{});
}

void Simulation::advance_step() {
  step_parts_.clear();
  step();
  stepper_.place_obstacles(world_);
  if (world_.steps % steps_per_frame_ == 0) require_all_near();
}

SimulatedFrame Simulation::present_frame() const {
  return {world_,   {contacts().begin(), contacts().end()}, step_parts_, stage_times_, driven_work_,
          gas_work_};
}

void Simulation::adopt(SimulatedFrame frame) {
  world_ = std::move(frame.world);
  other_contacts_ = std::move(frame.contacts);
  has_other_contacts_ = true;
  step_parts_ = std::move(frame.step_parts);
  stage_times_ = frame.stage_times;
  driven_work_ = frame.driven_work;
  gas_work_ = frame.gas_work;
}

void Simulation::step() {
  has_other_contacts_ = false;
  const auto divergence = stepper_.step(world_);
  driven_work_ = stepper_.driven_work();
  gas_work_ = stepper_.gas_work();
  if (!divergence) return;
  stepper_.place_obstacles(world_);
  // Parts of a step make no room for what is squeezed.
  const bool may_divide = divergence->stage != sim::Stage::find_contacts && divides();
  if (may_divide) {
    for (int parts = 2; parts <= greatest_step_parts; parts *= 2) {
      if (step_in_parts(parts)) return;
    }
  }
  const DivergenceError error = divergence_error(scene_.name, *divergence, world_, may_divide);
  if (!may_divide) throw error;
  DivergenceError of_parts(
      fmt::format("{}. Not even {} parts of the step do", error.what(), greatest_step_parts));
  of_parts.tried_parts = true;
  of_parts.is_crushed = error.is_crushed;
  of_parts.is_of_contact = error.is_of_contact;
  of_parts.steps_per_second = error.steps_per_second;
  throw of_parts;
}

/// In parts a step that is too long for small motions of the start would go on without end, and
/// what is drawn between its divergences would be no motion. By the start, so that a run that is
/// continued does the same.
bool Simulation::divides() const {
  if (on_divergence_ != OnDivergence::automatic) return on_divergence_ == OnDivergence::substep;
  return std::ranges::none_of(step_advices(build_world(scene_)), &StepAdvice::too_long);
}

/// Whether the next step is valid when it is done in so many. Depends on the world alone, so that a
/// run that is continued does the same.
bool Simulation::step_in_parts(int parts) {
  sim::World finer = world_;
  finer.settings.steps_per_second *= parts;
  finer.steps *= parts;
  sim::Stepper stepper(finer, {.threads = threads_, .profile = true, .plan = {}, .parts = parts});
  double driven_work = 0.0, gas_work = 0.0;
  bool is_valid = true;
  for (int i = 0; i < parts && is_valid; ++i) {
    is_valid = !stepper.step(finer);
    driven_work += stepper.driven_work();
    gas_work += stepper.gas_work();
  }
  times_of_parts_ = sum(times_of_parts_, stepper.stage_times());
  if (!is_valid) return false;
  has_other_contacts_ = true;
  other_contacts_.assign(stepper.contacts().begin(), stepper.contacts().end());
  driven_work_ = driven_work;
  gas_work_ = gas_work;
  finer.settings = world_.settings;
  finer.steps = world_.steps + 1;
  world_ = std::move(finer);
  step_parts_.push_back(parts);
  return true;
}

void Simulation::require_all_near() const {
  for (const sim::SoftBody& body : world_.soft) {
    require_near(body.name, body.positions.rows().cwiseAbs().maxCoeff());
  }
  for (const sim::RigidBox& box : world_.rigid) {
    require_near(box.name, box.position.cwiseAbs().maxCoeff());
  }
}

void Simulation::require_near(const std::string& body, double distance) const {
  if (distance < farthest) return;
  throw DivergenceError(
      fmt::format("{}: step {} (t = {:.4f} s): body {}: it is {:.3g} m away, too "
                  "far to be seen",
                  scene_.name, world_.steps, sim::time(world_), body, distance));
}

}  // namespace pneuma::app

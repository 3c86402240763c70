#include "app/world/step_advice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "app/world/distinct_bodies.h"
#include "scenes/loader/integrator_names.h"
#include "sim/joints/body_springs.h"
#include "sim/joints/spring_limit.h"
#include "sim/potential/world_vibration.h"

namespace pneuma::app {
namespace {

/// Of the limit: what a body does in earnest is a little stiffer than small motions.
constexpr double safe_share = 0.9;
/// Where bodies may lie on each other: nearer to the limit their contacts shake them.
constexpr double safe_share_in_contact = 0.75;
/// The same beside boxes, whose hits divide steps. By the integrators that are not Runge-Kutta
/// methods steps of two lengths do not commute: whole and divided ones in turn resonate with
/// motions that bear both, with those from 0.9 / step on where every second or third is divided.
/// The weaker resonances of rarer ones are left to damping.
constexpr double safe_share_of_divided = 0.45;
/// By how much shorter steps are to be that would be safe by the limit.
constexpr int blind_factor = 4;
constexpr int most_steps_per_second = 1'000'000;  // what a scene may ask for

/// Of a body of the world.
int index_of(const sim::World& world, const sim::SoftBody& body) {
  return static_cast<int>(&body - world.soft.data());
}

/// Whether most of the fastest motion of a body, which bears steps up to the `limit` (s), is that
/// of the springs on it.
bool is_of_springs(const sim::World& world, int soft_body, double limit) {
  if (!sim::has_springs(world, soft_body)) return false;
  const sim::SoftBody& body = world.soft[sim::at(soft_body)];
  const double own = sim::settled_stability_limit(world.settings.integrator, body).step;
  return limit < std::numbers::sqrt2 / 2.0 * own;
}

/// The stiffest spring on a body.
std::string spring_reason(const sim::World& world, int soft_body) {
  const sim::BodySpring* stiffest = nullptr;
  for (const sim::BodySpring& spring : world.springs) {
    if (spring.first.body != soft_body && spring.second.body != soft_body) continue;
    if (!stiffest || spring.k > stiffest->k) stiffest = &spring;
  }
  return fmt::format(
      "the [[spring]] from '{}' to '{}', k = {:g} N/m, damping = {:g} N s/m, with {}",
      world.soft[sim::at(stiffest->first.body)].name,
      world.soft[sim::at(stiffest->second.body)].name, stiffest->k, stiffest->damping,
      scenes::integrator_name(world.settings.integrator));
}

/// What makes the motion that fails first so fast.
std::string reason(const sim::World& world, const sim::SoftBody& body,
                   const sim::Oscillation& motion) {
  const sim::SoftMaterial& material = body.material;
  const std::string by = fmt::format("with {}", scenes::integrator_name(world.settings.integrator));
  if (motion.decay > std::sqrt(motion.squared_frequency)) {
    return fmt::format("k = {:g} N/m, whose damping k_max = {:g} N/m and rho_g = {:g} set, {}",
                       material.k, material.k_max, material.rho_g, by);
  }
  return fmt::format("k = {:g} N/m, n = {:g} mol, vertex_mass = {:g} kg {}", material.k, material.n,
                     material.vertex_mass, by);
}

/// What of bending makes steps short: without it they could be twice as long. Empty if nothing.
std::string bending_reason(const sim::World& world, const sim::SoftBody& body, double limit) {
  if (!(body.material.bending > 0.0)) return "";
  const sim::Integrator integrator = world.settings.integrator;
  const auto is_cause = [&](double sim::SoftMaterial::*part) {
    sim::SoftBody without = body;
    without.material.*part = 0.0;
    return sim::settled_stability_limit(integrator, without).step > 2.0 * limit;
  };
  const std::string name = scenes::integrator_name(integrator);
  if (body.material.bending_damping > 0.0 && is_cause(&sim::SoftMaterial::bending_damping)) {
    return fmt::format("bending_damping = {:g} s of bending = {:g} N m with {}",
                       body.material.bending_damping, body.material.bending, name);
  }
  if (!is_cause(&sim::SoftMaterial::bending)) return "";
  return fmt::format("bending = {:g} N m, vertex_mass = {:g} kg with {}", body.material.bending,
                     body.material.vertex_mass, name);
}

/// s; infinite where nothing touches, and where bodies are in each other.
double contact_limit(const sim::World& world) {
  try {
    sim::WorldVibration motions(world);
    if (motions.in_contact()) {
      return sim::stability_limit(motions, world.settings.integrator).step;
    }
  } catch (const std::invalid_argument&) {
  }
  return std::numeric_limits<double>::infinity();
}

bool may_meet_each_other(const sim::World& world) {
  int moving = 0;
  for (int i = 0; i < sim::body_count(world); ++i) moving += sim::is_kinematic(world, i) ? 0 : 1;
  return moving > 1;
}

/// Whether the steps are of an integrator that may resonate where they are divided, and may be.
bool may_resonate(const sim::World& world) {
  const sim::Integrator integrator = world.settings.integrator;
  return (integrator == sim::Integrator::symplectic_euler ||
          integrator == sim::Integrator::velocity_verlet) &&
         world.settings.contact == sim::ContactMethod::swept &&
         std::ranges::any_of(world.rigid,
                             [](const sim::RigidBox& box) { return !box.is_kinematic; });
}

double safe_share_of(const sim::World& world) {
  if (may_resonate(world)) return safe_share_of_divided;
  return may_meet_each_other(world) ? safe_share_in_contact : safe_share;
}

/// s: `limit`, that of the world's integrator, or less. Contacts act at the ends of a step,
/// whatever is done within it: where bodies press each other or the ground, rk8's long steps win
/// energy, and rk4's do not.
double limit_for_contacts(const sim::World& world, int soft_body, double limit) {
  const bool may_touch = world.settings.ground || sim::body_count(world) > 1;
  if (world.settings.integrator != sim::Integrator::rk8 || !may_touch) return limit;
  return std::min(limit, sim::joined_stability_limit(sim::Integrator::rk4, world, soft_body).step);
}

/// `limit`: s, for contacts.
void choose_steps(const sim::World& world, double limit, StepAdvice& advice) {
  advice.safe = safe_share_of(world) * limit;
  const double factor = advice.is_safe() ? blind_factor : std::ceil(advice.step / advice.safe);
  const double rate = factor * world.settings.steps_per_second;
  advice.steps_per_second = rate <= most_steps_per_second ? static_cast<int>(rate) : 0;
}

}  // namespace

StepAdvice step_advice(const sim::World& world, const sim::SoftBody& body) {
  const int index = index_of(world, body);
  const sim::StabilityLimit limit =
      sim::joined_stability_limit(world.settings.integrator, world, index);
  StepAdvice advice;
  advice.body = body.name;
  advice.step = sim::time_step(world.settings);
  advice.limit = limit.step;
  advice.of_springs = is_of_springs(world, index, limit.step);
  choose_steps(world, limit_for_contacts(world, index, limit.step), advice);
  if (!advice.is_safe() && !advice.of_springs) {
    advice.why = bending_reason(world, body, limit.step);
  }
  if (advice.why.empty()) {
    advice.why =
        advice.of_springs ? spring_reason(world, index) : reason(world, body, limit.motion);
  }
  advice.implicit_can = !advice.of_springs && !sim::is_implicit(world.settings.integrator) &&
                        sim::can_integrate(sim::Integrator::implicit_euler, body.material);
  return advice;
}

StepAdvice step_advice_in_contact(const sim::World& world, const sim::SoftBody& body) {
  StepAdvice advice = step_advice(world, body);
  if (world.settings.contact != sim::ContactMethod::potential) return advice;
  if (sim::is_implicit(world.settings.integrator)) return advice;
  const double limit = contact_limit(world);
  if (limit >= advice.limit) return advice;
  advice.limit = limit;
  advice.of_contact = true;
  advice.why = fmt::format("contact by potential with {}",
                           scenes::integrator_name(world.settings.integrator));
  choose_steps(world, limit_for_contacts(world, index_of(world, body), limit), advice);
  return advice;
}

std::string remedy(const StepAdvice& advice) {
  std::vector<std::string> ways;
  if (advice.steps_per_second > 0) {
    const double step = 1.0 / advice.steps_per_second;
    ways.push_back(fmt::format("a step of {:.3g} s for {} (--set simulation.steps_per_second={})",
                               step, advice.why, advice.steps_per_second));
  }
  if (advice.implicit_can) {
    // Where the step is not too long by what is known, a shorter one may not help either.
    ways.emplace(advice.too_long() ? ways.end() : ways.begin(),
                 "--set simulation.integrator=implicit_euler");
  } else if (advice.of_springs && ways.empty()) {
    ways.emplace_back("a smaller k or damping of " + advice.why);
  } else if (ways.empty()) {
    ways.emplace_back(
        "--set body.pressure_weighting=uniform --set simulation.integrator=implicit_euler");
  }
  return fmt::format("{}", fmt::join(ways, ", or "));
}

std::vector<StepAdvice> step_advices(const sim::World& world) {
  std::vector<StepAdvice> advices;
  std::vector<bool> is_known(world.soft.size(), false);
  for (const DistinctBody& body : distinct_bodies(world)) {
    advices.push_back(step_advice(world, *body.first));
    advices.back().count = body.count;
    is_known[sim::at(index_of(world, *body.first))] = true;
  }
  for (int i = 0; i < static_cast<int>(world.soft.size()); ++i) {
    const sim::SoftBody& body = world.soft[sim::at(i)];
    if (is_known[sim::at(i)] || sim::is_kinematic(body) || !sim::has_springs(world, i)) continue;
    advices.push_back(step_advice(world, body));
  }
  return advices;
}

std::string step_warning(const StepAdvice& advice) {
  return fmt::format(
      "{}: steps of {:.3g} s are longer than the {:.3g} s up to which small motions stay stable; "
      "use {}",
      body_and_alike(advice.body, advice.count), advice.step, advice.limit, remedy(advice));
}

}  // namespace pneuma::app

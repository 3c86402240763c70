#include "app/world/step_advice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "app/world/distinct_bodies.h"
#include "scenes/loader/integrator_names.h"
#include "sim/potential/world_vibration.h"
#include "sim/soft/stability_limit.h"

namespace pneuma::app {
namespace {

/// Of the limit: what a body does in earnest is a little stiffer than small motions.
constexpr double safe_share = 0.9;
/// By how much shorter steps are to be where the limit does not say.
constexpr int blind_factor = 4;
constexpr int most_steps_per_second = 1'000'000;  // what a scene may ask for

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

void choose_steps(const sim::World& world, StepAdvice& advice) {
  const double factor =
      advice.too_long() ? std::ceil(advice.step / (safe_share * advice.limit)) : blind_factor;
  const double rate = factor * world.settings.steps_per_second;
  advice.steps_per_second = rate <= most_steps_per_second ? static_cast<int>(rate) : 0;
}

}  // namespace

StepAdvice step_advice(const sim::World& world, const sim::SoftBody& body) {
  const sim::StabilityLimit limit = sim::settled_stability_limit(world.settings.integrator, body);
  StepAdvice advice;
  advice.body = body.name;
  advice.step = sim::time_step(world.settings);
  advice.limit = limit.step;
  advice.why = reason(world, body, limit.motion);
  advice.implicit_can = !sim::is_implicit(world.settings.integrator) &&
                        sim::can_integrate(sim::Integrator::implicit_euler, body.material);
  choose_steps(world, advice);
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
  choose_steps(world, advice);
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
    ways.emplace_back("--set simulation.integrator=implicit_euler");
  } else if (ways.empty()) {
    ways.emplace_back(
        "--set body.pressure_weighting=uniform --set simulation.integrator=implicit_euler");
  }
  return fmt::format("{}", fmt::join(ways, ", or "));
}

std::vector<StepAdvice> step_advices(const sim::World& world) {
  std::vector<StepAdvice> advices;
  for (const DistinctBody& body : distinct_bodies(world)) {
    advices.push_back(step_advice(world, *body.first));
    advices.back().count = body.count;
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

#include "app/world/scene_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/world/gas_warnings.h"
#include "app/world/may_start.h"
#include "scenes/loader/integrator_names.h"
#include "scenes/loader/load_scene.h"
#include "sim/inspect/closed_surface.h"
#include "sim/inspect/inspect.h"
#include "sim/mesh/measure.h"
#include "sim/potential/start_distance.h"

namespace pneuma::app {

namespace {

/// Null if there is none.
const scenes::BodyScene* find_body(const scenes::Scene& scene, const std::string& name) {
  const auto body = std::ranges::find_if(scene.bodies, [&](const scenes::BodyScene& candidate) {
    return name == candidate.name ||
           (scenes::copy_count(candidate) > 1 && name.starts_with(candidate.name + '.'));
  });
  return body == scene.bodies.end() ? nullptr : &*body;
}

}  // namespace

scenes::Place place_of(const scenes::Scene& scene, const std::string& name) {
  const scenes::BodyScene* body = find_body(scene, name);
  return body ? body->place : scenes::Place{};
}

namespace {

std::string warning_at(const scenes::Scene& scene, const std::string& name,
                       const std::string& what) {
  return to_string(scenes::diagnostic_at(place_of(scene, name), "warning: " + what));
}

/// Of the inflation that is asked for: what is closer is met.
constexpr double met_inflation = 0.02;

/// Empty if it is met, or not known.
std::string inflation_warning(const scenes::Scene& scene, const GasAdvice& advice) {
  const scenes::BodyScene* body = find_body(scene, advice.body);
  if (!body || !body->inflation || !advice.settled || advice.filled_at) return "";
  const double found = *advice.settled / advice.volume;
  if (std::abs(found / *body->inflation - 1.0) <= met_inflation) return "";
  const char* why = body->pinned.empty()
                        ? "its faces give way to next to no gas before its springs stretch; "
                          "bending makes them stiff, and greater values are met"
                        : "that is of the body without its pins";
  return fmt::format("body '{}': inflation = {:g} comes to {:.3g} times its volume: {}",
                     advice.body, *body->inflation, found, why);
}

/// What the potential of contact may hold at the start, of what bodies have to fall by their size
/// and of their motion: at rest on each other they keep less.
constexpr double loaded = 0.1;

/// J, of all bodies: m g L and what moves.
double usual_energy(const sim::World& world, double kinetic) {
  const double gravity = world.settings.gravity.norm();
  double sum = kinetic;
  for (const sim::SoftBody& body : world.soft) {
    const double mass = body.material.vertex_mass * body.positions.size();
    sum += mass * gravity * sim::bounds(body.positions).size().norm();
  }
  for (const sim::RigidBox& box : world.rigid) sum += box.mass * gravity * box.size.norm();
  return sum;
}

/// Bodies that start nearer to each other than they ever rest are shot apart, or clamped together.
void add_loaded_start(const scenes::Scene& scene, const sim::World& start,
                      std::vector<std::string>& warnings) {
  if (start.settings.contact != sim::ContactMethod::potential) return;
  const sim::Energy energy = sim::energy(start);
  if (energy.contact <= loaded * usual_energy(start, energy.kinetic)) return;
  const auto near = sim::find_nearest_start(start);
  if (!near || near->first == near->second) return;
  const bool on_ground = near->second < 0;
  const std::string body = sim::body_name(start, on_ground ? near->first : near->second);
  const std::string other =
      on_ground ? "the ground" : fmt::format("body '{}'", sim::body_name(start, near->first));
  warnings.push_back(warning_at(
      scene, body,
      fmt::format(
          "body '{}' starts {:.3g} m from {}, and contact with {:.3g} J: simulation.contact "
          "= \"potential\" pushes apart what is nearer than {:.3g} m; leave that much "
          "between bodies",
          body, near->distance, other, energy.contact, near->reach)));
}

/// Who asks for a bounce of more than half the speed, where steps of the first order damp it. A
/// restitution of 0.9 comes out as 0.2 in 240 steps per second, and as 0.8 in 3,840.
constexpr double bouncy = 0.5;
constexpr int fine_steps_per_second = 3'840;

void add_lost_bounce(const scenes::Scene& scene, std::vector<std::string>& warnings) {
  const sim::Settings& settings = scene.settings;
  if (settings.contact != sim::ContactMethod::potential ||
      settings.integrator != sim::Integrator::implicit_euler ||
      settings.steps_per_second >= fine_steps_per_second) {
    return;
  }
  const auto bounces = [](const scenes::BodyScene& body) {
    return body.surface.restitution > bouncy;
  };
  const auto body = std::ranges::find_if(scene.bodies, bounces);
  if (body == scene.bodies.end()) return;
  warnings.push_back(warning_at(
      scene, body->name,
      fmt::format("body '{}': restitution = {:g} comes out less, as simulation.integrator = "
                  "\"implicit_euler\" damps bounces in steps of {:.3g} s; \"sdirk2\" damps them "
                  "less, \"rk4\" hardly",
                  body->name, body->surface.restitution, sim::time_step(settings))));
}

std::string warning_of_file(const scenes::Scene& scene, const std::string& text) {
  scenes::Place place;  // the file as a whole
  if (!scene.bodies.empty()) place.file = scene.bodies.front().place.file;
  return to_string(scenes::diagnostic_at(place, "warning: " + text));
}

/// Its error of first order is energy: kept in steps of one length, won in each bounce in which
/// steps are divided while contacts press.
void add_won_energy(const scenes::Scene& scene, std::vector<std::string>& warnings) {
  if (scene.settings.contact != sim::ContactMethod::potential ||
      scene.settings.integrator != sim::Integrator::symplectic_euler) {
    return;
  }
  warnings.push_back(warning_of_file(
      scene,
      "simulation.integrator = \"symplectic_euler\" may gain energy where simulation.contact = "
      "\"potential\" divides its steps; \"velocity_verlet\" keeps it"));
}

/// Nothing limits the steps of implicit integrators, and impulses see only where they end.
void add_long_steps(const scenes::Scene& scene, const sim::World& start,
                    std::vector<std::string>& warnings) {
  if (scene.settings.contact != sim::ContactMethod::impulses ||
      !sim::is_implicit(scene.settings.integrator) || start.soft.empty() ||
      sim::body_count(start) < 2) {
    return;
  }
  const std::string integrator = scenes::integrator_name(scene.settings.integrator);
  warnings.push_back(warning_of_file(
      scene,
      fmt::format("simulation.contact = \"impulses\" may let bodies into each other, and add "
                  "energy, in steps as long as simulation.integrator = \"{}\" bears; set "
                  "simulation.contact to \"swept\"{}, or another integrator",
                  integrator, may_use_potential(scene, integrator) ? " or \"potential\"" : "")));
}

}  // namespace

std::vector<GasAdvice> gas_advices_before_run(const scenes::Scene& scene, const sim::World& start) {
  if (!scene.figure.empty()) return {};
  return gas_advices(start, quick_advice);
}

std::vector<std::string> scene_warnings(const scenes::Scene& scene, const sim::World& start,
                                        const std::vector<StepAdvice>& steps,
                                        const std::vector<GasAdvice>& gas) {
  std::vector<std::string> warnings = scene.warnings;
  for (const StepAdvice& advice : steps) {
    if (advice.too_long()) warnings.push_back(warning_at(scene, advice.body, step_warning(advice)));
  }
  for (const GasAdvice& advice : gas) {
    const std::string inflation = inflation_warning(scene, advice);
    if (!inflation.empty()) warnings.push_back(warning_at(scene, advice.body, inflation));
    if (advice.blown_up()) warnings.push_back(warning_at(scene, advice.body, gas_warning(advice)));
    if (advice.bursts()) warnings.push_back(warning_at(scene, advice.body, start_warning(advice)));
    if (advice.leaves_shape())
      warnings.push_back(warning_at(scene, advice.body, shape_warning(advice)));
    if (advice.crushed())
      warnings.push_back(warning_at(scene, advice.body, weight_warning(advice)));
  }
  add_loaded_start(scene, start, warnings);
  add_lost_bounce(scene, warnings);
  add_won_energy(scene, warnings);
  add_long_steps(scene, start, warnings);
  return warnings;
}

}  // namespace pneuma::app

#include "app/study/error/flight.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/host/errors.h"
#include "app/host/interrupt.h"
#include "app/study/error/samples.h"
#include "app/world/build_world.h"
#include "app/world/start_overlap.h"
#include "sim/mesh/measure.h"
#include "sim/step/stepper.h"

namespace pneuma::app {
namespace {

/// Short enough that in the time between two steps nothing comes and goes.
constexpr int looking_steps_per_second = 960;

void keep_body(sim::World& world, const std::string& name) {
  std::vector<std::string> names;
  for (const sim::SoftBody& body : world.soft) names.push_back(body.name);
  for (const sim::RigidBox& box : world.rigid) names.push_back(box.name);
  if (std::ranges::find(names, name) == names.end()) {
    throw UsageError(
        fmt::format("--body {}: the scene has no such body, but {}", name, fmt::join(names, ", ")));
  }
  const auto other = [&](const auto& body) { return body.name != name; };
  world.valves.clear();
  world.springs.clear();
  std::erase_if(world.soft, other);
  std::erase_if(world.rigid, other);
}

/// How to measure a body without the others: by options that the command has, or by another.
std::string way_out(const FlightOptions& options, std::string_view what) {
  return options.are_options
             ? fmt::format("name {} with --body", what)
             : fmt::format("`pneuma study error --body NAME` measures {} alone", what);
}

void check_soft_body(const scenes::Scene& scene, const sim::SoftBody& body,
                     const FlightOptions& options) {
  const auto unknown = [&](std::string_view what) {
    return fmt::format("{}: {}, which the solutions to compare with know nothing of: ", scene.name,
                       what);
  };
  if (sim::is_kinematic(body)) {
    throw UsageError(
        unknown(body.name + " is an obstacle of triangles (static, moved or wholly pinned)") +
        (options.are_options ? "name a soft body with --body, or add --free-flight"
                             : "`pneuma study error --free-flight` measures the "
                               "bodies without it"));
  }
  if (body.pins) {
    throw UsageError(unknown(body.name + " is pinned") + way_out(options, "another body"));
  }
  if (body.supply) {
    throw UsageError(unknown(fmt::format("the gas of {} comes and goes", body.name)) +
                     way_out(options, "another body"));
  }
  if (body.material.damping != sim::Damping::literal) return;
  throw UsageError(fmt::format(
      "{}: the damping of {} is literal, which depends on the step and so has no solution to "
      "compare with: add --set body.damping=dashpot; `pneuma study choices` measures literal "
      "damping",
      scene.name, body.name));
}

void check(const scenes::Scene& scene, const sim::World& world, const FlightOptions& options) {
  const bool has_boxes = world.settings.contact == sim::ContactMethod::potential &&
                         !std::ranges::all_of(world.rigid, &sim::RigidBox::is_kinematic);
  if (world.soft.empty() && !has_boxes) {
    throw UsageError(fmt::format(
        "{}: no soft body is left to study{}; simulation.contact = \"potential\" has solutions "
        "for free boxes alone as well",
        scene.name, options.body.empty() ? "" : "; name one with --body, or leave that out"));
  }
  if (!world.valves.empty() || !world.springs.empty()) {
    throw UsageError(fmt::format(
        "{}: valves or springs join its bodies, which the solutions to compare with know nothing "
        "of: {}",
        scene.name, way_out(options, "one body")));
  }
  for (const sim::SoftBody& body : world.soft) check_soft_body(scene, body, options);
}

void set_tumbling(sim::SoftBody& body) {
  constexpr double size = 0.9;
  constexpr double shear = 2.0;  // 1/s
  const sim::Vec3 spin = 3.0 * sim::Vec3::Ones().normalized();
  const sim::Vec3 centre = sim::mean(body.positions);
  for (int v = 0; v < body.positions.size(); ++v) {
    const sim::Vec3 arm = size * (body.positions[v] - centre);
    body.positions[v] = centre + arm;
    body.velocities[v] += spin.cross(arm) + shear * arm.z() * sim::Vec3::UnitX();
  }
}

sim::World with_looking_steps(sim::World world) {
  world.settings.integrator = sim::Integrator::rk4;
  world.settings.steps_per_second =
      std::max(world.settings.steps_per_second, looking_steps_per_second);
  return world;
}

std::int64_t steps_in(double seconds, const sim::World& world) {
  return std::llround(seconds * world.settings.steps_per_second);
}

std::optional<double> find_first_contact(const sim::World& start, double seconds) {
  sim::World world = with_looking_steps(start);
  sim::Stepper stepper(world);
  const bool by_potential = world.settings.contact == sim::ContactMethod::potential;
  if (!by_potential && !stepper.plan().runs(sim::Stage::find_contacts)) return std::nullopt;
  const auto steps = steps_in(seconds, world);
  for (std::int64_t i = 0; i < steps; ++i) {
    throw_if_interrupted();
    if (stepper.step(world) || !stepper.contacts().empty()) return sim::time(world);
  }
  return std::nullopt;
}

}  // namespace

double whole_samples(double seconds) {
  return std::max(1.0, std::floor(seconds * samples_per_second + 1e-9)) / samples_per_second;
}

Flight prepare_flight(const scenes::Scene& scene, const FlightOptions& options) {
  Flight flight;
  flight.world = build_world(scene);
  flight.world.settings.sleep_speed = 0.0;  // no part of the equation
  if (options.body.empty() && !options.free_flight) refuse_start_overlap(scene, flight.world);
  flight.seconds = whole_samples(std::min(options.seconds, scene.duration));
  if (!options.body.empty()) keep_body(flight.world, options.body);
  if (options.free_flight) {
    flight.world.settings.ground.reset();
    flight.world.rigid.clear();
    std::erase_if(flight.world.soft,
                  [](const sim::SoftBody& body) { return sim::is_kinematic(body); });
  }
  check(scene, flight.world, options);
  if (options.tumbling) std::ranges::for_each(flight.world.soft, set_tumbling);
  // Boxes alone turn by their own equation, which only the contact potential's solutions have.
  if (!options.free_flight) flight.first_contact = find_first_contact(flight.world, flight.seconds);
  const bool has_contacts =
      !options.free_flight && (flight.world.soft.empty() || flight.first_contact);
  // Its search for contacts is no part of a free flight.
  if (!has_contacts && flight.world.settings.contact == sim::ContactMethod::potential) {
    flight.world.settings.contact = sim::ContactMethod::swept;
  }
  if (options.free_flight) {
    flight.description = "free flight, as asked for: without ground, boxes and contacts";
  } else if (has_contacts) {
    flight.contacts = true;
    flight.description = "with contacts";
  } else {
    flight.world.rigid.clear();
    flight.description = "free flight: nothing touches anything in this time";
  }
  if (options.tumbling) flight.description += "; starts with spin, shear and slack springs";
  return flight;
}

int max_contacts(const Flight& flight, double seconds) {
  if (!flight.contacts) return 0;
  sim::World world = with_looking_steps(flight.world);
  sim::Stepper stepper(world);
  const auto steps = steps_in(seconds, world);
  std::size_t most = 0;
  for (std::int64_t i = 0; i < steps; ++i) {
    throw_if_interrupted();
    if (stepper.step(world)) break;
    most = std::max(most, stepper.contacts().size());
  }
  return static_cast<int>(most);
}

}  // namespace pneuma::app

#include "app/world/settled_volume.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/host/interrupt.h"
#include "sim/mesh/measure.h"
#include "sim/soft/pressure_force.h"
#include "sim/soft/stability_limit.h"
#include "sim/step/stepper.h"

namespace pneuma::app {
namespace {

/// Of the volume, from one step to the next: less is at rest.
constexpr double settled_change = 1e-4;
constexpr int most_steps = 100;

/// From so many vertices on the factors that implicit steps need take longer than all of the short
/// explicit steps in which a body comes to rest.
constexpr int many_vertices = 5'000;

/// The body alone at rest in its shape, in steps of a second: most bodies swing faster than that,
/// and what swings faster than an implicit Euler step dies away in it.
sim::World quiet_world(const sim::SoftBody& body) {
  sim::World world;
  world.settings.ground.reset();
  world.settings.gravity.setZero();
  world.settings.integrator = sim::Integrator::implicit_euler;
  world.settings.steps_per_second = 1;
  world.soft.push_back(body);
  sim::SoftBody& alone = world.soft.front();
  alone.supply = nullptr;
  alone.velocities = sim::VertexArray(alone.positions.size());
  alone.material.pressure_weighting = sim::PressureWeighting::uniform;
  alone.material.damping = sim::Damping::dashpot;
  alone.material.rho_g = 0.0;
  return world;
}

/// m^3, at which the gas pushes no more than what is outside.
double balanced_volume(const sim::GasLaw& law) {
  if (law.ambient_pressure == 0.0) return std::numeric_limits<double>::infinity();
  if (law.exponent == 1.0) return law.strength / law.ambient_pressure;
  const double start = sim::absolute_pressure(law, law.start_volume);
  return law.start_volume * std::pow(start / law.ambient_pressure, 1.0 / law.exponent);
}

/// Of the springs' own pressure: what is outside of a body whose volume is to be found.
constexpr double tightness = 10.0;

/// Pa with which the springs of a body at rest press on its gas: at s times the size its energy is
/// as small as can be, so that 3 (P - p0) V = sum k (l - L) l.
double spring_pressure(const sim::SoftBody& body, double volume) {
  double sum = 0.0;
  for (int e = 0; e < body.mesh->topology.edge_count(); ++e) {
    const auto& [a, b] = body.mesh->topology.edges()[sim::at(e)];
    const double length = (body.positions[b] - body.positions[a]).norm();
    sum += (length - body.mesh->rest_lengths[sim::at(e)]) * length;
  }
  return body.material.k * sum / (3.0 * volume);
}

/// Pa: of springs stretched by their whole length.
double spring_pressure_scale(const sim::SoftBody& body, double volume) {
  double squares = 0.0;
  for (const double length : body.mesh->rest_lengths) squares += length * length;
  return body.material.k * squares / (3.0 * volume);
}

double volume_of(const sim::World& world) {
  const sim::SoftBody& body = world.soft.front();
  return sim::volume(body.mesh->topology, body.positions);
}

/// kg per N/m of a whole body at most: where it rests does not depend on its mass, and what swings
/// so slowly that it moves little in a step of quiet_world would be taken for settled. The
/// lightest are for those that find no rest.
constexpr double moderate = 2.0, lightest = 0.1;

sim::SoftBody with_mass_per_k(sim::SoftBody body, double most) {
  const double mass = most * body.material.k / body.positions.size();
  if (mass > 0.0) body.material.vertex_mass = std::min(mass, body.material.vertex_mass);
  return body;
}

std::optional<sim::SoftBody> find_settled(const sim::SoftBody& body) {
  sim::World world = quiet_world(body);
  double last = volume_of(world);
  sim::Stepper stepper(world);
  for (int i = 0; i < most_steps; ++i) {
    throw_if_interrupted();
    if (stepper.step(world)) return std::nullopt;
    const double now = volume_of(world);
    if (std::abs(now - last) < settled_change * now) return std::move(world.soft.front());
    last = now;
  }
  return std::nullopt;
}

/// A round body swings in and out some sqrt(N) times more slowly than one of its N vertices.
int steps_of_a_swing(const sim::SoftBody& body) {
  return static_cast<int>(10.0 * std::sqrt(body.positions.size()));
}

/// The fraction of velocity that air takes in 1/60 s when it halves a swing in half of its time.
double halving_friction(double step, int steps) {
  return 1.0 - std::pow(0.5, 1.0 / (60.0 * step * 0.5 * steps));
}

/// By explicit steps, whose swings air takes. None when it finds no rest, or they are too long.
std::optional<sim::SoftBody> find_settled_by_short_steps(const sim::SoftBody& body) {
  constexpr double safety = 0.8;          // of the longest stable step: the body changes its shape
  constexpr double least_step = 1e-9;     // s
  constexpr double settled_swing = 3e-4;  // of the volume, from its least to its greatest
  constexpr int most_swings = 40;
  sim::World world = quiet_world(body);
  world.settings.integrator = sim::Integrator::symplectic_euler;
  const double limit =
      safety * sim::settled_stability_limit(world.settings.integrator, world.soft.front()).step;
  if (!(limit > least_step)) return std::nullopt;
  world.settings.steps_per_second = std::max(1, static_cast<int>(std::ceil(1.0 / limit)));
  const int steps = steps_of_a_swing(body);
  world.soft.front().material.rho_g = halving_friction(sim::time_step(world.settings), steps);
  sim::Stepper stepper(world);
  for (int swing = 0; swing < most_swings; ++swing) {
    double least = std::numeric_limits<double>::infinity(), greatest = 0.0;
    for (int i = 0; i < steps; ++i) {
      throw_if_interrupted();
      if (stepper.step(world)) return std::nullopt;
      const double now = volume_of(world);
      least = std::min(least, now);
      greatest = std::max(greatest, now);
    }
    if (greatest - least < settled_swing * greatest) return std::move(world.soft.front());
  }
  return std::nullopt;
}

std::optional<double> find_held_pressure(const sim::SoftBody& body, double volume) {
  sim::World world = quiet_world(body);
  sim::SoftBody& alone = world.soft.front();
  sim::SoftMaterial& material = alone.material;
  material.gas_exponent = 1.0;
  const double outside = tightness * spring_pressure_scale(body, volume);
  material.ambient_pressure = outside;
  sim::Stepper stepper(world);
  double held = spring_pressure(alone, volume);
  for (int i = 0; i < most_steps; ++i) {
    material.n = (outside + held) * volume / (sim::gas_constant * material.temperature);
    if (stepper.step(world)) return std::nullopt;
    const double now = spring_pressure(alone, volume_of(world));
    const bool settled = std::abs(now - held) < settled_change * outside / tightness &&
                         std::abs(volume_of(world) - volume) < settled_change * volume;
    held = now;
    if (settled) return held;
  }
  return std::nullopt;
}

}  // namespace

std::optional<sim::SoftBody> settled_body(const sim::SoftBody& body) {
  std::optional<sim::SoftBody> settled;
  if (body.positions.size() >= many_vertices) settled = find_settled_by_short_steps(body);
  if (!settled) settled = find_settled(with_mass_per_k(body, moderate));
  if (!settled) settled = find_settled(with_mass_per_k(body, lightest));
  if (settled) {
    settled->material = body.material;
    settled->velocities = body.velocities;
  }
  return settled;
}

std::optional<double> settled_volume(const sim::SoftBody& body) {
  const sim::GasLaw law = sim::gas_law(body.material);
  const bool gas = law.strength > 0.0;
  if (gas && body.material.k == 0.0) return balanced_volume(law);
  if (!gas) return sim::volume(body.mesh->topology, body.positions);
  const auto settled = settled_body(body);
  if (!settled) return std::nullopt;
  return sim::volume(settled->mesh->topology, settled->positions);
}

std::optional<double> held_pressure(const sim::SoftBody& body, double volume) {
  if (body.material.k == 0.0) return 0.0;
  const auto held = find_held_pressure(with_mass_per_k(body, moderate), volume);
  return held ? held : find_held_pressure(with_mass_per_k(body, lightest), volume);
}

}  // namespace pneuma::app

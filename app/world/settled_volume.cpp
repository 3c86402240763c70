#include "app/world/settled_volume.h"

#include <cmath>
#include <limits>

#include "sim/mesh/measure.h"
#include "sim/soft/pressure_force.h"
#include "sim/step/stepper.h"

namespace pneuma::app {
namespace {

/// Of the volume, from one step to the next: less is at rest.
constexpr double settled_change = 1e-4;
constexpr int most_steps = 100;

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
  alone.velocities = sim::VertexArray(alone.positions.size());
  alone.material.pressure_weighting = sim::PressureWeighting::uniform;
  alone.material.damping = sim::Damping::dashpot;
  alone.material.rho_g = 0.0;
  return world;
}

double volume_of(const sim::World& world) {
  const sim::SoftBody& body = world.soft.front();
  return sim::volume(body.mesh->topology, body.positions);
}

}  // namespace

std::optional<double> settled_volume(const sim::SoftBody& body) {
  const bool gas = sim::gas_strength(body.material) > 0.0;
  if (gas && body.material.k == 0.0) return std::numeric_limits<double>::infinity();
  sim::World world = quiet_world(body);
  double last = volume_of(world);
  if (!gas) return last;
  sim::Stepper stepper(world);
  for (int i = 0; i < most_steps; ++i) {
    if (stepper.step(world)) return std::nullopt;
    const double now = volume_of(world);
    if (std::abs(now - last) < settled_change * now) return now;
    last = now;
  }
  return std::nullopt;
}

}  // namespace pneuma::app

// Worlds in which contact is a potential.
#pragma once

#include "sim/potential/contact_potential.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {

inline World potential_world(Integrator integrator, int steps_per_second) {
  World world;
  world.settings.contact = ContactMethod::potential;
  world.settings.integrator = integrator;
  world.settings.steps_per_second = steps_per_second;
  return world;
}

inline SoftBody soft_ball(const Vec3& position, const Vec3& velocity, int subdivisions = 1) {
  SoftBody body = make_body(make_icosphere(1.0, subdivisions), position);
  body.material.k = 200.0;
  body.material.n = 0.05;
  body.material.vertex_mass = 0.1;
  for (int v = 0; v < body.velocities.size(); ++v) body.velocities[v] = velocity;
  return body;
}

/// Two balls in the air, a tenth of a second before they touch, beside each other's middle.
inline World meeting_balls(Integrator integrator, int steps_per_second) {
  World world = potential_world(integrator, steps_per_second);
  world.settings.ground.reset();
  world.settings.gravity.setZero();
  world.soft.push_back(soft_ball({-1.1, 0, 0}, {1, 0, 0}));
  world.soft.push_back(soft_ball({1.1, 0.2, 0.1}, {-1, 0, 0}));
  for (SoftBody& ball : world.soft) ball.material.rho_g = 0.0;
  return world;
}

}  // namespace pneuma::sim

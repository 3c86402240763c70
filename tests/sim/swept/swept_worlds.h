// Worlds for the tests of swept contacts.
#pragma once

#include "tests/support/worlds.h"

namespace pneuma::sim {

inline World make_swept_world() {
  World world;
  world.settings.contact = ContactMethod::swept;
  return world;
}

/// The paper's sphere, soft, with little gas.
inline SoftBody make_ball(const Vec3& position, const Vec3& velocity = Vec3::Zero()) {
  SoftBody ball = make_body(make_sphere(3.0, 8, 8), position);
  ball.material.n = 0.5;
  for (int v = 0; v < ball.velocities.size(); ++v) ball.velocities[v] = velocity;
  return ball;
}

}  // namespace pneuma::sim

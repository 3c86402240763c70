// Worlds for the tests of swept contacts.
#pragma once

#include "sim/equilibrium/held_shape.h"
#include "sim/inspect/inspect.h"
#include "sim/soft/pins.h"
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

/// A ball of 1 m and 10 kg without friction or drag that keeps its shape under 300 Pa.
inline SoftBody make_sliding_ball(int subdivisions, const Vec3& position, const Vec3& velocity) {
  SoftBody ball = make_body(make_icosphere(1.0, subdivisions), position);
  ball.material.n = 300.0 * volume_of(ball) / (gas_constant * ball.material.temperature);
  ball.material.k = 900.0;
  ball.material.vertex_mass = 10.0 / ball.positions.size();
  ball.material.rho_g = 0.0;
  ball.material.surface = {0.0, 0.0};
  ball.mesh = held_mesh(*ball.mesh, ball.positions, ball.material);
  for (int v = 0; v < ball.velocities.size(); ++v) ball.velocities[v] = velocity;
  return ball;
}

/// Without gas or friction: all of its vertices are pinned where they are.
inline SoftBody make_smooth_obstacle(const TriangleMesh& mesh, const Vec3& position) {
  SoftBody body = make_body(mesh, position);
  const auto count = static_cast<std::size_t>(body.positions.size());
  GivenMotion motion;
  motion.position = position;
  body.pins = make_pins(body.positions, std::vector<std::uint8_t>(count, 1),
                        std::vector<std::uint8_t>(count, 0), motion);
  body.material.n = 0.0;
  body.material.surface = {0.0, 0.0};
  return body;
}

}  // namespace pneuma::sim

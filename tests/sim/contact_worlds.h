// Worlds in which bodies of all kinds meet.
#pragma once

#include "tests/support/worlds.h"

namespace pneuma::sim {

/// The paper's sphere and torus, as firm as in the contact scenes.
inline SoftBody sphere(const Vec3& position) {
  SoftBody body = make_body(make_sphere(3.0, 8, 8), position);
  body.material.n = 1.0;
  body.material.surface.restitution = 0.0;
  return body;
}

inline SoftBody torus(double radius, const Vec3& position) {
  SoftBody body = make_body(make_torus(radius, 2.0, 16, 16), position);
  body.material.k = 200.0;
  body.material.n = 2.0;
  body.material.surface.restitution = 0.0;
  return body;
}

inline void push(SoftBody& body, const Vec3& velocity) {
  for (int v = 0; v < body.velocities.size(); ++v) body.velocities[v] += velocity;
}

/// Nothing acts from outside: no ground, no gravity, no drag.
inline World isolated() {
  World world;
  world.settings.ground.reset();
  world.settings.gravity.setZero();
  return world;
}

inline void add(World& world, SoftBody body) {
  if (world.settings.gravity.isZero()) body.material.rho_g = 0.0;
  world.soft.push_back(std::move(body));
}

inline void add(World& world, RigidBox box) {
  if (world.settings.gravity.isZero()) box.rho_g = 0.0;
  world.rigid.push_back(std::move(box));
}

/// Two spheres fly at each other, each at `speed`, a little off centre.
inline World meeting_spheres(double speed, std::uint64_t seed) {
  World world = isolated();
  world.settings.seed = seed;
  add(world, sphere({-4.0, 0.0, 0.0}));
  add(world, sphere({4.0, 0.3, -0.2}));
  push(world.soft[0], {speed, 0.0, 0.0});
  push(world.soft[1], {-speed, 0.0, 0.0});
  return world;
}

inline World box_on_sphere() {
  World world;
  add(world, sphere({0.0, 0.0, 3.0}));
  add(world, make_rigid({2.0, 2.0, 2.0}, {0.2, 0.1, 9.0}, 5.0));
  return world;
}

inline World sphere_on_box() {
  World world;
  add(world, sphere({0.1, 0.2, 7.0}));
  add(world, make_rigid({4.0, 4.0, 2.0}, {0.0, 0.0, 1.0}, 50.0));
  return world;
}

inline World sphere_in_torus() {
  World world;
  add(world, torus(5.5, {0.0, 0.0, 2.6}));
  world.soft[0].material.vertex_mass = 0.2;
  add(world, sphere({0.0, 0.0, 6.5}));
  world.soft[1].material.vertex_mass = 0.1;
  return world;
}

}  // namespace pneuma::sim

// Bodies that sleep: at rest, they have left the step (ERRATA row 71).
#pragma once

#include "sim/world/world.h"

namespace pneuma::sim {

/// Soft bodies come first, then boxes.
inline bool is_asleep(const World& world, int body) {
  return !world.rest.empty() && world.rest[at(body)].group >= 0;
}

/// Whether no impulse moves it in this step.
inline bool is_fixed(const World& world, int body) {
  return is_kinematic(world, body) || is_asleep(world, body);
}

/// Whether it has a velocity. Obstacles that never move have none, however many vertices.
inline bool moves(const World& world, int body) {
  const int box = body - static_cast<int>(world.soft.size());
  if (box < 0) {
    const SoftBody& soft = world.soft[at(body)];
    return !is_still(soft) && !soft.velocities.rows().isZero(0.0);
  }
  return !world.rigid[at(box)].velocity.isZero(0.0) ||
         !world.rigid[at(box)].angular_velocity.isZero(0.0);
}

/// With all that fell asleep with it. Whoever changes a sleeping body's positions from outside must
/// wake it; velocities wake it by themselves.
inline void wake(World& world, int body) {
  if (!is_asleep(world, body)) return;
  const int group = world.rest[at(body)].group;
  for (BodyRest& rest : world.rest) {
    if (rest.group == group) rest = {};
  }
}

}  // namespace pneuma::sim

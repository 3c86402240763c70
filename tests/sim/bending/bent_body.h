// Bodies with hinges, bent out of their shape, and what forces between their vertices must keep.
#pragma once

#include <gtest/gtest.h>

#include "tests/support/worlds.h"

namespace pneuma::sim {

constexpr double rigidity = 7.0;  // N m

/// With hinges at rest in its shape, and moved out of it at random by up to `amount` (m, m/s).
inline SoftBody bent(const TriangleMesh& mesh, double amount, unsigned seed) {
  SoftBody body = make_body(mesh, {1.0, -2.0, 3.0});
  body.mesh = with_hinges(*body.mesh);
  perturb(body, amount, seed);
  return body;
}

inline void expect_to_push_and_turn_nothing_as_a_whole(const VertexArray& force,
                                                       const SoftBody& body) {
  Vec3 net = Vec3::Zero(), torque = Vec3::Zero();
  for (int v = 0; v < force.size(); ++v) {
    net += force[v];
    torque += Vec3(body.positions[v]).cross(Vec3(force[v]));
  }
  EXPECT_LT(net.norm(), 1e-12 * force.rows().norm());
  EXPECT_LT(torque.norm(), 1e-11 * force.rows().norm());  // arms of some metres
}

}  // namespace pneuma::sim

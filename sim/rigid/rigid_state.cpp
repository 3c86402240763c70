#include "sim/rigid/rigid_state.h"

#include "sim/rigid/inertia.h"

namespace pneuma::sim {

RigidState state_of(const RigidBox& box) {
  return {box.position, box.orientation, box.velocity, box.angular_velocity};
}

void set_state(RigidBox& box, const RigidState& state) {
  box.position = state.position;
  box.orientation = state.orientation;
  box.velocity = state.velocity;
  box.angular_velocity = state.angular_velocity;
}

Vec3 spin(const RigidBox& box, const RigidState& state) {
  const Eigen::Quaterniond& q = state.orientation;
  return q * body_inertia(box).cwiseProduct(q.conjugate() * state.angular_velocity);
}

}  // namespace pneuma::sim

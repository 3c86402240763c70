// What of a box changes with time. Not for users of the library.
#pragma once

#include "sim/world/rigid_box.h"

namespace pneuma::sim {

struct RigidState {
  Vec3 position = Vec3::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
};

RigidState state_of(const RigidBox& box);
void set_state(RigidBox& box, const RigidState& state);
/// Angular momentum of the box in that state about its centre, kg m^2/s.
Vec3 spin(const RigidBox& box, const RigidState& state);

}  // namespace pneuma::sim

// The motion of all bodies as a step found it. Not for users of the library.
#pragma once

#include <vector>

#include "sim/soft/soft_state.h"
#include "sim/world/world.h"

namespace pneuma::sim {

struct RigidStart {
  Vec3 position = Vec3::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
};

/// integrate_soft and integrate_rigid write it, resolve_contacts reads it, and a step that fails is
/// taken back to it.
struct MotionStart {
  std::vector<SoftState> soft;    // per soft body
  std::vector<RigidStart> rigid;  // per box
};

RigidStart motion_of(const RigidBox& box);
void set_motion(RigidBox& box, const RigidStart& start);

void keep_soft(const World& world, std::vector<SoftState>& start);
void keep_rigid(const World& world, std::vector<RigidStart>& start);
void restore_soft(World& world, const std::vector<SoftState>& start);
void restore_rigid(World& world, const std::vector<RigidStart>& start);

}  // namespace pneuma::sim

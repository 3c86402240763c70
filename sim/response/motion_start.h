// The motion of all bodies as a step found it. Not for users of the library.
#pragma once

#include <vector>

#include "sim/rigid/rigid_state.h"
#include "sim/soft/soft_state.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// integrate_soft and integrate_rigid write it, resolve_contacts reads it, and a step that fails is
/// taken back to it. Of obstacles that a step leaves where they are it knows nothing.
struct MotionStart {
  std::vector<SoftState> soft;    // per soft body
  std::vector<RigidState> rigid;  // per box
};

void keep_soft(const World& world, std::vector<SoftState>& start);
void keep_rigid(const World& world, std::vector<RigidState>& start);
void restore_soft(World& world, const std::vector<SoftState>& start);
void restore_rigid(World& world, const std::vector<RigidState>& start);

}  // namespace pneuma::sim

#include "sim/response/motion_start.h"

#include "sim/soft/pins.h"

namespace pneuma::sim {

void keep_soft(const World& world, std::vector<SoftState>& start) {
  start.resize(world.soft.size());
  for (std::size_t i = 0; i < start.size(); ++i) {
    start[i].positions = world.soft[i].positions;
    start[i].velocities = world.soft[i].velocities;
  }
}

void keep_rigid(const World& world, std::vector<RigidState>& start) {
  start.resize(world.rigid.size());
  for (std::size_t i = 0; i < start.size(); ++i) start[i] = state_of(world.rigid[i]);
}

void restore_soft(World& world, const std::vector<SoftState>& start) {
  for (std::size_t i = 0; i < start.size(); ++i) {
    if (is_still(world.soft[i]) || start[i].positions.size() == 0) continue;
    world.soft[i].positions = start[i].positions;
    world.soft[i].velocities = start[i].velocities;
  }
}

void restore_rigid(World& world, const std::vector<RigidState>& start) {
  for (std::size_t i = 0; i < start.size(); ++i) set_state(world.rigid[i], start[i]);
}

}  // namespace pneuma::sim

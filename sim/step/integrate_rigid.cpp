#include "sim/rigid/rigid_motion.h"
#include "sim/step/stages.h"

namespace pneuma::sim {

std::optional<Divergence> integrate_rigid(World& world, StepWorkspace& workspace) {
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    const RigidBox& box = world.rigid[i];
    workspace.rigid_start[i] = {box.position, box.orientation, box.velocity, box.angular_velocity};
  }
  for (RigidBox& box : world.rigid) {
    move_freely(box, world.settings.gravity, time_step(world.settings));
    if (!box.position.allFinite() || !box.orientation.coeffs().allFinite() ||
        !box.velocity.allFinite() || !box.angular_velocity.allFinite()) {
      return Divergence{Stage::integrate_rigid, world.steps + 1, box.name,
                        "its position, orientation or velocity is not a finite number: it was hit "
                        "too hard"};
    }
  }
  return std::nullopt;
}

}  // namespace pneuma::sim

#include "sim/rigid/rigid_motion.h"
#include "sim/step/stages.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

std::optional<Divergence> integrate(const World& world, RigidBox& box) {
  const auto move = is_as_printed(world.settings) ? move_as_printed : move_freely;
  move(box, world.settings.gravity, time_step(world.settings));
  if (box.position.allFinite() && box.orientation.coeffs().allFinite() &&
      box.velocity.allFinite() && box.angular_velocity.allFinite()) {
    return std::nullopt;
  }
  return Divergence{Stage::integrate_rigid, world.steps + 1, box.name,
                    "its position, orientation or velocity is not a finite number: it was hit "
                    "too hard"};
}

}  // namespace

std::optional<Divergence> integrate_rigid(World& world, std::vector<RigidState>& start) {
  keep_rigid(world, start);
  const int soft = static_cast<int>(world.soft.size());
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    if (is_asleep(world, soft + static_cast<int>(i))) continue;
    if (auto divergence = integrate(world, world.rigid[i])) return divergence;
  }
  return std::nullopt;
}

std::optional<Divergence> integrate_rigid_again(World& world, int box, const RigidState& start) {
  RigidBox& moved = world.rigid[at(box)];
  set_state(moved, start);
  return integrate(world, moved);
}

}  // namespace pneuma::sim

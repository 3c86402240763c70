#include "app/world/smallest_box.h"

#include <algorithm>
#include <cmath>

namespace pneuma::app {
namespace {

constexpr double steps_of_fall = 6.0;
/// So that a grain does not slow a whole run down without end.
constexpr double most_steps_for_size = 2'000.0;

}  // namespace

double SmallestBox::steps_per_second() const {
  return std::min(most_steps_for_size, steps_of_fall / fall_time);
}

std::optional<SmallestBox> smallest_box(const sim::World& world) {
  const double gravity = world.settings.gravity.norm();
  if (gravity == 0.0) return std::nullopt;
  std::optional<SmallestBox> smallest;
  for (const sim::RigidBox& box : world.rigid) {
    const double extent = std::cbrt(box.size.prod());
    if (box.is_kinematic || (smallest && extent >= smallest->extent)) continue;
    smallest = SmallestBox{box.name, extent, std::sqrt(2.0 * extent / gravity)};
  }
  return smallest;
}

}  // namespace pneuma::app

#include "app/check/frame_motion.h"

#include <algorithm>

#include "sim/collision/oriented_box.h"
#include "sim/mesh/measure.h"
#include "sim/response/fall_asleep.h"
#include "sim/soft/pins.h"

namespace pneuma::app {
namespace {

/// m, of a corner.
double longest_way(const sim::RigidBox& box, const sim::RigidState& before) {
  const auto place = [](const sim::Vec3& position, const Eigen::Quaterniond& orientation,
                        const sim::Vec3& half) {
    return sim::OrientedBox{position, orientation.toRotationMatrix(), half};
  };
  const sim::OrientedBox now = place(box.position, box.orientation, 0.5 * box.size),
                         then = place(before.position, before.orientation, 0.5 * box.size);
  double longest = 0.0;
  for (int i = 0; i < 8; ++i) longest = std::max(longest, (now.corner(i) - then.corner(i)).norm());
  return longest;
}

}  // namespace

void keep_places(const sim::World& world, Places& places) {
  places.soft.resize(world.soft.size());
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    if (!sim::is_kinematic(world.soft[i])) places.soft[i] = world.soft[i].positions;
  }
  places.boxes.clear();
  for (const sim::RigidBox& box : world.rigid) places.boxes.push_back(sim::state_of(box));
}

std::vector<double> rest_limits(const sim::World& world) {
  std::vector<double> limits;
  for (int i = 0; i < sim::body_count(world); ++i) {
    limits.push_back(rest_speed * sim::length_of_rest(world, i));
  }
  return limits;
}

void Motion::meet(double speed, const std::string& body, double limit) {
  if (speed > fastest.speed) fastest = {speed, body, limit};
  if (speed / limit > liveliest.over_limit()) liveliest = {speed, body, limit};
}

Motion motion(const sim::World& world, const Places& before, double duration,
              const std::vector<double>& limits) {
  Motion found;
  for (std::size_t i = 0; i < before.soft.size(); ++i) {
    if (before.soft[i].size() == 0) continue;
    const sim::SoftBody& body = world.soft[i];
    found.meet(sim::max_distance(before.soft[i], body.positions) / duration, body.name, limits[i]);
  }
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    const sim::RigidBox& box = world.rigid[i];
    if (box.is_kinematic) continue;
    // No point of a box is farther from its axis of rotation than half the diagonal.
    const double rim = box.angular_velocity.norm() * 0.5 * box.size.norm();
    const double speed =
        std::max(box.velocity.norm() + rim, longest_way(box, before.boxes[i]) / duration);
    found.meet(speed, box.name, limits[world.soft.size() + i]);
  }
  return found;
}

}  // namespace pneuma::app

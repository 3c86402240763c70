#include "app/check/frame_motion.h"

#include <algorithm>
#include <array>

#include "sim/collision/oriented_box.h"
#include "sim/mesh/measure.h"
#include "sim/response/fall_asleep.h"
#include "sim/soft/pins.h"

namespace pneuma::app {
namespace {

std::array<sim::Vec3, 8> corners(const sim::RigidBox& box, const sim::RigidState& state) {
  return sim::corners({state.position, state.orientation.toRotationMatrix(), 0.5 * box.size});
}

/// m/s, over the `duration` (s) since it was there: of a corner, which no point is faster than; the
/// greater of its way and of its velocity now.
double fastest_corner(const sim::RigidBox& box, const sim::RigidState& before, double duration) {
  const auto now = corners(box, sim::state_of(box)), then = corners(box, before);
  double fastest = 0.0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const sim::Vec3 velocity = box.velocity + box.angular_velocity.cross(now[i] - box.position);
    fastest = std::max({fastest, velocity.norm(), (now[i] - then[i]).norm() / duration});
  }
  return fastest;
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
    const double speed = fastest_corner(box, before.boxes[i], duration);
    found.meet(speed, box.name, limits[world.soft.size() + i]);
  }
  return found;
}

}  // namespace pneuma::app

#include "app/world/fastest_motion.h"

#include <algorithm>
#include <span>
#include <vector>

#include "app/world/touch.h"
#include "sim/mesh/primitives.h"
#include "sim/rigid/given_motion.h"

namespace pneuma::app {
namespace {

/// Of the soft body's extent, in a step.
constexpr double way_of_extent = 0.1;
/// So that a motion of an instant does not slow a whole run down without end.
constexpr double most_steps_for_speed = 2'000.0;
/// Between two keys, where a smooth curve is fastest within.
constexpr int parts_between_keys = 8;

/// What is moved, as a rigid piece.
struct MovedPiece {
  sim::GivenMotion motion;
  std::vector<sim::Vec3> arms;  // m, of its vertices from the position, before it is turned
};

MovedPiece piece_of(const sim::RigidBox& box) {
  MovedPiece piece;
  if (box.motion) {
    piece.motion = *box.motion;
  } else {
    piece.motion.orientation = box.orientation;
    piece.motion.velocity = box.velocity;
    piece.motion.angular_velocity = box.angular_velocity;
  }
  piece.arms = sim::make_box(box.size, 1).vertices;
  return piece;
}

MovedPiece piece_of(const sim::Pins& pins) {
  MovedPiece piece{pins.motion, {}};
  for (int v = 0; v < pins.start.size(); ++v) {
    piece.arms.push_back(sim::Vec3(pins.start[v]) - pins.motion.position);
  }
  return piece;
}

/// s, up to `duration`.
std::vector<double> times_of(const sim::KeyFrames& keys, double duration) {
  std::vector<double> times = {0.0};
  for (const std::vector<sim::KeyFrame>* track : {&keys.path, &keys.rotation}) {
    double start = 0.0;
    for (const sim::KeyFrame& key : *track) {
      const double end = std::min(key[0], duration);
      for (int part = 1; part <= parts_between_keys; ++part) {
        times.push_back(start + (end - start) * part / parts_between_keys);
      }
      start = end;
    }
  }
  return times;
}

double fastest_vertex(const MovedPiece& piece, double duration) {
  double reach = 0.0, fastest = 0.0;
  for (const sim::Vec3& arm : piece.arms) reach = std::max(reach, arm.norm());
  for (const double time : times_of(piece.motion.keys, duration)) {
    const sim::Velocities velocities = sim::velocities_at(piece.motion, time);
    if (velocities.linear.norm() + reach * velocities.angular.norm() <= fastest) continue;
    const sim::Mat3 turn = sim::pose_at(piece.motion, time).orientation.toRotationMatrix();
    for (const sim::Vec3& arm : piece.arms) {
      const sim::Vec3 velocity = velocities.linear + velocities.angular.cross(turn * arm);
      fastest = std::max(fastest, velocity.norm());
    }
  }
  return fastest;
}

}  // namespace

double FastestMotion::steps_per_second() const {
  return std::min(most_steps_for_speed, speed / (way_of_extent * extent));
}

std::optional<FastestMotion> fastest_motion(const sim::World& world, double duration) {
  FastestMotion result;
  const auto take = [&](const std::string& body, const MovedPiece& piece) {
    const double speed = fastest_vertex(piece, duration);
    if (speed <= result.speed) return;
    result.body = body;
    result.speed = speed;
  };
  for (const sim::RigidBox& box : world.rigid) {
    if (box.is_kinematic) take(box.name, piece_of(box));
  }
  for (int i = 0; i < static_cast<int>(world.soft.size()); ++i) {
    const sim::SoftBody& body = world.soft[sim::at(i)];
    if (sim::is_kinematic(body)) {
      if (!sim::is_still(body)) take(body.name, piece_of(*body.pins));
      continue;
    }
    const double extent = least_extent(world, i);
    if (!result.soft.empty() && extent >= result.extent) continue;
    result.soft = body.name;
    result.extent = extent;
  }
  if (result.body.empty() || result.soft.empty() || !(result.extent > 0.0)) return std::nullopt;
  return result;
}

}  // namespace pneuma::app

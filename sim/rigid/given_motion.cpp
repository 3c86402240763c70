#include "sim/rigid/given_motion.h"

#include <algorithm>
#include <numbers>

#include "sim/mesh/rotation.h"
#include "sim/rigid/rigid_motion.h"

namespace pneuma::sim {
namespace {

double time_of(const KeyFrame& key) { return key[0]; }
Vec3 value_of(const KeyFrame& key) { return {key[1], key[2], key[3]}; }

double duration(const KeyFrame& from, const KeyFrame& to) { return time_of(to) - time_of(from); }

/// Per second, between two keys.
Vec3 slope(const KeyFrame& from, const KeyFrame& to) {
  return (value_of(to) - value_of(from)) / duration(from, to);
}

/// Of the smooth curve at key i: the harmonic mean of the slopes on both sides, weighted by their
/// durations.
Vec3 slope_at(std::span<const KeyFrame> keys, std::size_t i) {
  if (i == 0 || i + 1 == keys.size()) return Vec3::Zero();
  const double before = duration(keys[i - 1], keys[i]), after = duration(keys[i], keys[i + 1]);
  const double share = (before + 2.0 * after) / (3.0 * (before + after));
  const Vec3 in = slope(keys[i - 1], keys[i]), out = slope(keys[i], keys[i + 1]);
  Vec3 result = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    if (in[axis] * out[axis] <= 0.0) continue;
    result[axis] = in[axis] * out[axis] / (share * out[axis] + (1.0 - share) * in[axis]);
  }
  return result;
}

/// Hermite's form of the cubic between keys i and i + 1, at a part of the way.
Vec3 cubic(std::span<const KeyFrame> keys, std::size_t i, double part) {
  const double seconds = duration(keys[i], keys[i + 1]);
  const Vec3 from = value_of(keys[i]), way = value_of(keys[i + 1]) - from;
  const Vec3 start = seconds * slope_at(keys, i), end = seconds * slope_at(keys, i + 1);
  const double rest = 1.0 - part;
  return from + part * part * (3.0 - 2.0 * part) * way + part * rest * (rest * start - part * end);
}

/// Its derivative by the part of the way.
Vec3 cubic_rate(std::span<const KeyFrame> keys, std::size_t i, double part) {
  const double seconds = duration(keys[i], keys[i + 1]);
  const Vec3 way = value_of(keys[i + 1]) - value_of(keys[i]);
  const Vec3 start = seconds * slope_at(keys, i), end = seconds * slope_at(keys, i + 1);
  const double rest = 1.0 - part;
  return 6.0 * part * rest * way + rest * (rest - 2.0 * part) * start +
         part * (part - 2.0 * rest) * end;
}

/// Of the key that ends the part of the way at a time between the first and the last.
std::size_t next_key(std::span<const KeyFrame> keys, double time) {
  std::size_t next = 1;
  while (time_of(keys[next]) <= time) ++next;
  return next;
}

/// The derivative of value_at, per second.
Vec3 rate_at(std::span<const KeyFrame> keys, bool smooth, double time) {
  if (keys.empty() || time < time_of(keys.front()) || time >= time_of(keys.back())) {
    return Vec3::Zero();
  }
  const std::size_t next = next_key(keys, time);
  const double seconds = duration(keys[next - 1], keys[next]);
  if (!smooth) return slope(keys[next - 1], keys[next]);
  return cubic_rate(keys, next - 1, (time - time_of(keys[next - 1])) / seconds) / seconds;
}

/// The rotation vector in world axes that turns one orientation into another, rad.
Vec3 rotation_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  const Eigen::AngleAxisd turn(to * from.conjugate());
  return turn.angle() * turn.axis();
}

}  // namespace

Vec3 value_at(std::span<const KeyFrame> keys, bool smooth, double time) {
  if (keys.empty()) return Vec3::Zero();
  if (time <= time_of(keys.front())) return value_of(keys.front());
  if (time >= time_of(keys.back())) return value_of(keys.back());
  const std::size_t next = next_key(keys, time);
  const double part = (time - time_of(keys[next - 1])) / duration(keys[next - 1], keys[next]);
  if (smooth) return cubic(keys, next - 1, part);
  return (1.0 - part) * value_of(keys[next - 1]) + part * value_of(keys[next]);
}

Pose pose_at(const GivenMotion& motion, double time) {
  const KeyFrames& keys = motion.keys;
  const Vec3 degrees = value_at(keys.rotation, keys.smooth, time);
  Pose pose{motion.position + value_at(keys.path, keys.smooth, time) + time * motion.velocity,
            rotation_of_degrees(degrees) * motion.orientation};
  if (!motion.angular_velocity.isZero(0.0)) {
    pose.orientation = turned(pose.orientation, time * motion.angular_velocity);
  }
  return pose;
}

Velocities velocities_at(const GivenMotion& motion, double time) {
  const KeyFrames& keys = motion.keys;
  const Vec3 angles = value_at(keys.rotation, keys.smooth, time) * std::numbers::pi / 180.0;
  const Vec3 rates = rate_at(keys.rotation, keys.smooth, time) * std::numbers::pi / 180.0;
  // About world x, then y, then z: what is turned later turns the axes of what was turned before.
  const Eigen::AngleAxisd about_z(angles.z(), Vec3::UnitZ()), about_y(angles.y(), Vec3::UnitY());
  const Vec3 of_keys = rates.z() * Vec3::UnitZ() + about_z * (rates.y() * Vec3::UnitY()) +
                       about_z * (about_y * (rates.x() * Vec3::UnitX()));
  Velocities result{rate_at(keys.path, keys.smooth, time) + motion.velocity, of_keys};
  if (!motion.angular_velocity.isZero(0.0)) {
    const Eigen::Quaterniond on_top =
        turned(Eigen::Quaterniond::Identity(), time * motion.angular_velocity);
    result.angular = motion.angular_velocity + on_top * of_keys;
  }
  return result;
}

void aim_given_motions(World& world) {
  const double step = time_step(world.settings);
  const double end = static_cast<double>(world.steps + 1) / world.settings.steps_per_second;
  for (RigidBox& box : world.rigid) {
    if (!box.motion) continue;
    const Pose pose = pose_at(*box.motion, end);
    box.velocity = (pose.position - box.position) / step;
    box.angular_velocity = rotation_between(box.orientation, pose.orientation) / step;
  }
}

void place_given_motions(World& world, double time) {
  for (RigidBox& box : world.rigid) {
    if (!box.motion) continue;
    const Pose pose = pose_at(*box.motion, time);
    box.position = pose.position;
    box.orientation = pose.orientation;
  }
}

}  // namespace pneuma::sim

#include "sim/rigid/rigid_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/rigid/inertia.h"

namespace pneuma::sim {

bool is_cube(const RigidBox& box) {
  return box.size.x() == box.size.y() && box.size.y() == box.size.z();
}

namespace {

/// rad, by which a box turns in one of the steps of turned_freely, about: in longer ones the energy
/// does not keep to its mean.
constexpr double max_turn = 0.2;
/// Of these in one step, however fast the box turns.
constexpr double max_turns = 1000.0;

/// The axis of the top that the body is most like, and the two across it.
struct TopAxes {
  int alone = 0;
  int like = 1;
  int other = 2;
};

TopAxes axes_of_top(const Vec3& inverse_inertia) {
  TopAxes axes;
  double least = std::numeric_limits<double>::infinity();
  for (int alone = 0; alone < 3; ++alone) {
    const int like = (alone + 1) % 3, other = (alone + 2) % 3;
    const double difference = std::abs(inverse_inertia[like] - inverse_inertia[other]);
    if (difference >= least) continue;
    least = difference;
    axes = {alone, like, other};
  }
  return axes;
}

/// The angular momentum stays, and the angular velocity follows the orientation.
void rotate_freely(RigidBox& box, double step) {
  if (is_cube(box)) {
    box.orientation = turned(box.orientation, box.angular_velocity * step);
    return;
  }
  const Vec3 angular_momentum = spin(box);
  box.orientation = turned_freely(box, box.orientation, angular_momentum, step);
  box.angular_velocity = world_inverse_inertia(box) * angular_momentum;
}

}  // namespace

Eigen::Quaterniond turned(const Eigen::Quaterniond& orientation, const Vec3& rotation) {
  const double angle = rotation.norm();
  if (angle == 0.0) return orientation;
  return (Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation / angle)) * orientation)
      .normalized();
}

Eigen::Quaterniond turned_freely(const RigidBox& box, const Eigen::Quaterniond& orientation,
                                 const Vec3& angular_momentum, double duration) {
  const Vec3 inertia = body_inertia(box);
  if (is_cube(box)) return turned(orientation, duration / inertia.x() * angular_momentum);
  const Vec3 inverse = inertia.cwiseInverse();
  const TopAxes top = axes_of_top(inverse);
  Eigen::Quaterniond result = orientation;
  const auto turn = [&](int axis, double time) {
    const Vec3 direction = result * Vec3::Unit(axis);
    const double rate = angular_momentum.dot(direction) * (inverse[axis] - inverse[top.like]);
    result = turned(result, time * rate * direction);
  };
  if (inverse[top.like] == inverse[top.other]) {
    turn(top.alone, duration);
  } else {
    const Vec3 along = orientation.conjugate() * angular_momentum;
    const double angle = duration * along.cwiseProduct(inverse).norm();
    const double parts = std::clamp(std::ceil(angle / max_turn), 1.0, max_turns);
    const double part = duration / parts;
    for (double done = 0.0; done < parts; ++done) {
      turn(top.other, 0.5 * part);
      turn(top.alone, part);
      turn(top.other, 0.5 * part);
    }
  }
  return turned(result, duration * inverse[top.like] * angular_momentum);
}

void move_freely(RigidBox& box, const Vec3& gravity, double step) {
  box.position += step * box.velocity;
  if (box.is_kinematic) {
    box.orientation = turned(box.orientation, box.angular_velocity * step);
    return;
  }
  rotate_freely(box, step);
  add_gravity_and_drag(box, gravity, step);
}

Vec3 missing_fall(const RigidBox& box, const RigidState& start, double step) {
  return 0.5 * step * (box.velocity - start.velocity);
}

void add_gravity_and_drag(RigidBox& box, const Vec3& gravity, double step) {
  const double rate = -60.0 * std::log1p(-box.rho_g);  // 1/s
  const double kept = std::exp(-rate * step);
  // s, of gravity. What rounds to no drag is none.
  const double time_felt = kept < 1.0 ? -std::expm1(-rate * step) / rate : step;
  box.velocity = kept * box.velocity + time_felt * gravity;
  box.angular_velocity *= kept;
}

void move_as_printed(RigidBox& box, const Vec3& gravity, double step) {
  box.velocity += step * gravity;
  box.position += step * box.velocity;
  box.orientation = turned(box.orientation, box.angular_velocity * step);
  box.velocity *= 1.0 - box.rho_g;
  box.angular_velocity *= 1.0 - box.rho_g;
}

}  // namespace pneuma::sim

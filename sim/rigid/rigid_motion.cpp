#include "sim/rigid/rigid_motion.h"

#include <cmath>

#include "sim/rigid/inertia.h"

namespace pneuma::sim {

bool is_cube(const RigidBox& box) {
  return box.size.x() == box.size.y() && box.size.y() == box.size.z();
}

namespace {

/// Torque-free rotation: the angular momentum L stays, omega = I^-1 L follows the orientation. The
/// kinetic energy is a sum over the body's axes, L_x^2 / (2 I_x) and so on, and under one term
/// alone the body turns evenly about that axis, by t L_x / I_x. These turns, made one after the
/// other and back, are a step of second order that is symplectic: the error of the energy does not
/// add up (Touma and Wisdom 1994, "Lie-Poisson integrators for rigid body dynamics in the solar
/// system").
void rotate_freely(RigidBox& box, double step) {
  if (is_cube(box)) {
    box.orientation = turned(box.orientation, box.angular_velocity * step);
    return;
  }
  const Vec3 angular_momentum = spin(box);
  const Vec3 inertia = body_inertia(box);
  const auto turn = [&](int axis, double duration) {
    const Vec3 direction = box.orientation * Vec3::Unit(axis);
    const double rate = angular_momentum.dot(direction) / inertia[axis];
    box.orientation = turned(box.orientation, duration * rate * direction);
  };
  turn(0, 0.5 * step);
  turn(1, 0.5 * step);
  turn(2, step);
  turn(1, 0.5 * step);
  turn(0, 0.5 * step);
  box.angular_velocity = world_inverse_inertia(box) * angular_momentum;
}

}  // namespace

Eigen::Quaterniond turned(const Eigen::Quaterniond& orientation, const Vec3& rotation) {
  const double angle = rotation.norm();
  if (angle == 0.0) return orientation;
  return (Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation / angle)) * orientation)
      .normalized();
}

void move_freely(RigidBox& box, const Vec3& gravity, double step) {
  box.position += step * box.velocity;
  if (box.is_kinematic) {
    box.orientation = turned(box.orientation, box.angular_velocity * step);
    return;
  }
  rotate_freely(box, step);
  const double kept = std::pow(1.0 - box.rho_g, 60.0 * step);
  box.velocity = kept * (box.velocity + step * gravity);
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

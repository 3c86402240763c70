#include "sim/boxes/slow_boxes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "sim/rigid/inertia.h"

namespace pneuma::sim {
namespace {

Mat3 inertia_in_world(const RigidBox& box) {
  const Mat3 axes = box.orientation.toRotationMatrix();
  return axes * body_inertia(box).asDiagonal() * axes.transpose();
}

/// The rigid motion with the momentum and angular momentum of all.
struct CommonMotion {
  Vec3 centre = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();

  Vec3 at_point(const Vec3& point) const {
    return velocity + angular_velocity.cross(point - centre);
  }
};

CommonMotion common_motion(std::span<RigidBox* const> boxes) {
  CommonMotion common;
  double mass = 0.0;
  for (const RigidBox* box : boxes) {
    mass += box->mass;
    common.centre += box->mass * box->position;
    common.velocity += box->mass * box->velocity;
  }
  common.centre /= mass;
  common.velocity /= mass;
  Vec3 turning = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
  for (const RigidBox* box : boxes) {
    const Vec3 arm = box->position - common.centre;
    turning += box->mass * arm.cross(box->velocity - common.velocity) + spin(*box);
    inertia += box->mass * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose()) +
               inertia_in_world(*box);
  }
  common.angular_velocity = inertia.ldlt().solve(turning);
  return common;
}

}  // namespace

double slow_boxes(std::span<RigidBox* const> boxes, bool are_held, double energy) {
  const CommonMotion common = are_held ? CommonMotion{} : common_motion(boxes);
  double there_is = 0.0;
  for (const RigidBox* box : boxes) {
    const Vec3 turns = box->angular_velocity - common.angular_velocity;
    const Vec3 moves = box->velocity - common.at_point(box->position);
    there_is +=
        0.5 * box->mass * moves.squaredNorm() + 0.5 * turns.dot(inertia_in_world(*box) * turns);
  }
  const double taken = std::min(energy, there_is);
  if (!(taken > 0.0)) return 0.0;
  const double factor = std::sqrt(1.0 - taken / there_is);
  for (RigidBox* box : boxes) {
    const Vec3 there = common.at_point(box->position);
    box->velocity = there + factor * (box->velocity - there);
    box->angular_velocity =
        common.angular_velocity + factor * (box->angular_velocity - common.angular_velocity);
  }
  return taken;
}

}  // namespace pneuma::sim

#include "sim/potential/box_inertia.h"

#include <algorithm>
#include <cmath>

#include "sim/rigid/inertia.h"
#include "sim/rigid/rigid_motion.h"

namespace pneuma::sim {
namespace {

/// rad, of the parts in which a box turns freely.
constexpr double max_part = 0.1;
constexpr int max_parts = 10'000;
constexpr int max_fixed_point_iterations = 100;

/// Body rates times h at the middle of a part, from the momentum in body axes where it starts:
/// r = h I^-1 (P + P') / 2 with P' - P = (P + P') / 2 x r.
Vec3 middle_turn(const Vec3& momentum, const Vec3& inertia, double step) {
  Vec3 turn = step * momentum.cwiseQuotient(inertia);
  for (int i = 0; i < max_fixed_point_iterations; ++i) {
    // P' = (1 + r/2 x)^-1 (1 - r/2 x) P, so that (P + P') / 2 = (1 + r/2 x)^-1 P
    const Vec3 half = 0.5 * turn;
    const Vec3 middle =
        (momentum + momentum.cross(half) + half.dot(momentum) * half) / (1.0 + half.squaredNorm());
    const Vec3 next = step * middle.cwiseQuotient(inertia);
    const bool is_done = (next - turn).norm() <= 1e-16 * next.norm();
    turn = next;
    if (is_done) break;
  }
  return turn;
}

/// Turns a box without a torque, so that its energy and its angular momentum stay but for rounding:
/// the implicit midpoint rule for the momentum in body axes, and for the orientation the Cayley
/// transform of the same rate (Austin, Krishnaprasad and Wang, "Almost Poisson integration of rigid
/// body systems", 1993). Of second order in parts of 0.1 rad; of a cube exact.
void turn_freely(RigidBox& box, double step) {
  if (is_cube(box)) {
    box.orientation = turned(box.orientation, box.angular_velocity * step);
    return;
  }
  const Vec3 momentum = spin(box), inertia = body_inertia(box);
  const double angle = step * momentum.norm() / inertia.minCoeff();
  const int parts = std::clamp(static_cast<int>(std::min(angle / max_part, 1e6)) + 1, 1, max_parts);
  for (int i = 0; i < parts; ++i) {
    const Vec3 own = box.orientation.conjugate() * momentum;
    const Vec3 half = 0.5 * middle_turn(own, inertia, step / parts);
    box.orientation =
        (box.orientation * Eigen::Quaterniond(1.0, half.x(), half.y(), half.z())).normalized();
  }
  box.angular_velocity = world_inverse_inertia(box) * momentum;
}

}  // namespace

BoxInertia::BoxInertia(const RigidBox& box) : box_(box) {
  box_.name.clear();  // a copy takes no memory
}

void BoxInertia::set_step(const RigidState& base, const Vec3& gravity, double beta) {
  kept_ = 1.0 / (1.0 - 60.0 * std::log1p(-box_.rho_g) * beta);
  base_ = base;
  beta_ = beta;
  scale_ = 1.0 / (kept_ * beta * beta);
  set_state(box_, base);
  box_.velocity = kept_ * (base.velocity + beta * gravity);
  box_.angular_velocity *= kept_;
  box_.position += beta * box_.velocity;
  turn_freely(box_, beta);
}

double BoxInertia::energy(const Pose& pose) const {
  const Mat3 apart = pose.orientation.toRotationMatrix() - box_.orientation.toRotationMatrix();
  return 0.5 * scale_ *
         (box_.mass * (pose.position - box_.position).squaredNorm() +
          axis_moments().dot(apart.colwise().squaredNorm().transpose()));
}

Vec6 BoxInertia::gradient(const Pose& pose) const {
  const Mat3 axes = pose.orientation.toRotationMatrix(), free = box_.orientation.toRotationMatrix();
  const Vec3 moments = axis_moments();
  Vec3 torque = Vec3::Zero();
  for (int k = 0; k < 3; ++k) torque += moments[k] * free.col(k).cross(axes.col(k));
  Vec6 result;
  result << scale_ * box_.mass * (pose.position - box_.position), scale_ * torque;
  return result;
}

Mat6 BoxInertia::hessian(const Pose& pose) const {
  const Mat3 axes = pose.orientation.toRotationMatrix(), free = box_.orientation.toRotationMatrix();
  const Vec3 moments = axis_moments();
  Mat3 turning = Mat3::Zero();
  for (int k = 0; k < 3; ++k) {
    const Mat3 outer = axes.col(k) * free.col(k).transpose();
    turning += moments[k] * (outer.trace() * Mat3::Identity() - 0.5 * (outer + outer.transpose()));
  }
  Mat6 result = Mat6::Zero();
  result.topLeftCorner<3, 3>() = per_length() * Mat3::Identity();
  result.bottomRightCorner<3, 3>() = scale_ * turning;
  return result;
}

RigidState BoxInertia::state_at(const Pose& pose) const {
  RigidState state;
  state.position = pose.position;
  state.orientation = pose.orientation;
  state.velocity = box_.velocity + (pose.position - box_.position) / beta_;
  const Vec3 change = gradient(pose).tail<3>() / (scale_ * beta_);
  const Vec3 momentum = spin(box_) + change;
  state.angular_velocity = rate_of(box_, pose.orientation, momentum);
  return state;
}

RigidState BoxInertia::extrapolate(const RigidState& middle, double factor) const {
  const auto along = [&](const Vec3& from, const Vec3& to) -> Vec3 {
    return from + factor * (to - from);
  };
  RigidBox free = box_;
  set_state(free, base_);
  free.angular_velocity *= kept_;
  turn_freely(free, factor * beta_);
  const Eigen::AngleAxisd by_forces(middle.orientation * box_.orientation.conjugate());
  RigidState result;
  result.position = along(base_.position, middle.position);
  result.velocity = along(base_.velocity, middle.velocity);
  result.orientation = turned(free.orientation, factor * by_forces.angle() * by_forces.axis());
  result.angular_velocity =
      rate_of(box_, result.orientation, along(spin(box_, base_), spin(box_, middle)));
  return result;
}

double kinetic_energy(const RigidBox& box, const RigidState& state) {
  return 0.5 * box.mass * state.velocity.squaredNorm() +
         0.5 * state.angular_velocity.dot(spin(box, state));
}

Vec3 rate_of(const RigidBox& box, const Eigen::Quaterniond& orientation, const Vec3& momentum) {
  return orientation *
         body_inertia(box).cwiseInverse().cwiseProduct(orientation.conjugate() * momentum);
}

void move_corners(const RigidState& box, int first_vertex, const VertexArray& positions,
                  VertexArray& velocities) {
  for (int v = first_vertex; v < first_vertex + box_corners; ++v) {
    const Vec3 arm = positions[v] - box.position;
    velocities[v] = box.velocity + box.angular_velocity.cross(arm);
  }
}

// x(theta) = r + theta x r + 1/2 theta x (theta x r) + ...
Mat3 turning_hessian(const BoxFrame& frame, const VertexArray& slopes) {
  Mat3 sum = Mat3::Zero();
  for (int i = 0; i < box_corners; ++i) {
    const Vec3 slope = slopes[frame.first_vertex + i];
    const Mat3 outer = slope * frame.arms[at(i)].transpose();
    sum += 0.5 * (outer + outer.transpose()) - outer.trace() * Mat3::Identity();
  }
  return sum;
}

}  // namespace pneuma::sim

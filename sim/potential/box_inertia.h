// The part of a free box in the incremental potential of a step of beta seconds.
//
// With p~ and R~ where the box would be without forces, a_k and b_k the axes of R and R~, and
// J_k = m s_k^2 / 12 for its sizes s_k, it is the integral over the box of density / 2 beta^2 times
// the squared distance of its points from where they would be,
//
//   m / (2 beta^2) |p - p~|^2  +  1 / (2 beta^2) sum over k  J_k |a_k - b_k|^2,
//
// both divided by what drag leaves of a velocity, as in sim/soft/implicit_step.h (Ferguson et al.,
// "Intersection-free rigid body dynamics", 2021, with R~ a rotation: that of the box turning
// freely, which keeps its angular momentum, in place of R + beta dR/dt). The orientation is a
// rotation throughout: nothing is projected.
#pragma once

#include "sim/potential/box_frame.h"
#include "sim/rigid/given_motion.h"
#include "sim/rigid/inertia.h"
#include "sim/rigid/rigid_state.h"

namespace pneuma::sim {

class BoxInertia {
 public:
  /// Of a box of the world; not of its state.
  explicit BoxInertia(const RigidBox& box);

  /// For a step of `beta` seconds from `base`.
  void set_step(const RigidState& base, const Vec3& gravity, double beta);

  double energy(const Pose& pose) const;  // J
  /// Force in N and torque in N m, with which it grows as the box moves and turns.
  Vec6 gradient(const Pose& pose) const;
  /// Its second derivative by dp and dtheta, N/m and N m.
  Mat6 hessian(const Pose& pose) const;

  /// The state at the end of the step, of a pose at which forces balance: the change of momentum
  /// and of angular momentum is beta times force and torque there.
  RigidState state_at(const Pose& pose) const;

  /// sdirk2's second base: from where the step began by `factor` as far as to `middle`, at which it
  /// ended. Of the turn only what forces added to the free one is multiplied, so that a free box
  /// keeps its energy.
  RigidState extrapolate(const RigidState& middle, double factor) const;

  double per_length() const { return scale_ * box_.mass; }  // N/m
  /// N m per rad about each of its axes, of turns from where it would be without forces.
  Vec3 turning_inertia() const { return scale_ * body_inertia(box_); }
  /// m^2: the mean of the squares of r from the centre along an axis, which compares turns with
  /// ways.
  double squared_radius() const { return box_.size.squaredNorm() / 36.0; }

 private:
  Vec3 axis_moments() const { return box_.mass / 12.0 * box_.size.cwiseAbs2(); }  // J, kg m^2

  RigidBox box_;  // where it would be without forces
  RigidState base_;
  double kept_ = 1.0;  // of velocities, by drag
  double beta_ = 1.0;
  double scale_ = 0.0;  // 1/s^2: 1 / (kept beta^2)
};

/// J, of motion.
double kinetic_energy(const RigidBox& box, const RigidState& state);
/// rad/s, of an angular momentum.
Vec3 rate_of(const RigidBox& box, const Eigen::Quaterniond& orientation, const Vec3& momentum);
/// Of a box with these positions of its corners, their velocities.
void move_corners(const RigidState& box, int first_vertex, const VertexArray& positions,
                  VertexArray& velocities);

/// What the second derivative gains, by dtheta, as turning corners move along curves: of forces
/// that are the slopes of an energy by the corners' ways.
Mat3 turning_hessian(const BoxFrame& frame, const VertexArray& slopes);

}  // namespace pneuma::sim

// The coordinates of a free box for explicit integrators, which know positions, velocities and
// accelerations only (sim/soft/explicit_step.h).
//
// They stand in the places of its first corners, the others' are zero. Of the first corner: the
// position of its centre, its velocity and acceleration. Of the next, by what the integrator is to
// keep:
//
//   Form::quaternion  the orientation q (vector; of a third corner: scalar), dq/dt and
//                     d^2q/dt^2 = (dw/dt q + w dq/dt) / 2, w = I^-1 L being the angular velocity:
//                     smooth in time, so that every method has its own order.
//   Form::momentum    the integral of the angular momentum L over the step, L itself, and the
//                     torque. The box is turned as by L without a torque, for as long as that
//                     integral takes: with velocity_verlet a kick, a free turn and a kick, which is
//                     symplectic and the same backwards, and of second order at most.
//
// Both lose the fraction rho_g of their velocities in 1/60 s as the equation of soft bodies does.
#pragma once

#include "sim/potential/box_frame.h"
#include "sim/rigid/rigid_state.h"

namespace pneuma::sim {

class BoxCoordinates {
 public:
  enum class Form { quaternion, momentum };

  /// Of a box of the world; not of its state.
  BoxCoordinates(const RigidBox& box, int first_vertex, Form form);

  /// Where a step starts.
  void start(const RigidState& state, VertexArray& positions, VertexArray& velocities);
  RigidState state(const VertexArray& positions, const VertexArray& velocities) const;

  /// From force in N and torque in N m about the centre, in the same state.
  void accelerate(const RigidState& state, const Vec6& force, const Vec3& gravity,
                  VertexArray& acceleration) const;

  /// 1/kg: f . M^-1 f of a force and torque of no unit.
  double mobility(const RigidState& state, const Vec6& force) const;

 private:
  Eigen::Quaterniond orientation(const VertexArray& positions) const;

  RigidBox box_;
  int first_vertex_;
  Form form_;
  double drag_rate_;                 // 1/s
  Eigen::Quaterniond start_turned_;  // where the integral of the angular momentum is zero
};

}  // namespace pneuma::sim

// Free motion of a rigid box over one step (paper 4.1).
#pragma once

#include "sim/rigid/rigid_state.h"
#include "sim/world/rigid_box.h"

namespace pneuma::sim {

/// The orientation turned by a rotation vector in world axes, rad: q' = [cos(theta/2),
/// sin(theta/2) omega/|omega|] q with theta = |omega| t. A zero vector turns nothing (ERRATA row
/// 9).
Eigen::Quaterniond turned(const Eigen::Quaterniond& orientation, const Vec3& rotation);

/// A cube turns freely about any axis.
bool is_cube(const RigidBox& box);

/// The orientation after `duration` s without a torque, of a box with this size and mass and an
/// angular momentum in world axes, kg m^2/s. The kinetic energy is that of a symmetric top, of the
/// two moments that are most alike, and L_j^2 (1/I_j - 1/I_i) / 2. The top turns evenly about the
/// angular momentum and about its own axis; under the rest alone the body turns evenly about its
/// axis j. These turns, made one after the other and back, are a step of second order that is
/// symplectic and the same backwards: the error of the energy does not add up (Touma and Wisdom
/// 1994, "Lie-Poisson integrators for rigid body dynamics in the solar system"), as long as the
/// body turns by little in each: several are made of a long one. Of a top, and of a cube, exact.
/// Turns about the three axes alone would bring a thin rod's angular momentum across it onto the
/// axis of its least moment.
Eigen::Quaterniond turned_freely(const RigidBox& box, const Eigen::Quaterniond& orientation,
                                 const Vec3& angular_momentum, double duration);

/// Euler-Cromer: alternately v += a t and p += v t, the same for the orientation. A step begins
/// with p, so that contacts act on a velocity between the force that changed it and the motion it
/// makes: what they bring to rest does not move at all. Beginning with v, as the paper writes it,
/// everything at rest would sink by g t^2 in each step and creep down every slope
/// (ERRATA row 36).
///
/// A box that is not a cube also gets the gyroscopic term (ERRATA row 9), by keeping its angular
/// momentum instead of its angular velocity: exactly kept, whatever the step. Drag takes the
/// fraction rho_g of both velocities per 1/60 s, and velocities are those of v' = g - gamma v in
/// closed form (ERRATA row 35).
void move_freely(RigidBox& box, const Vec3& gravity, double step);
/// m. What such a step leaves out of the way of a box that nothing touches, of which `start` is the
/// start: half of what the velocity has changed by. With it a flight without drag is a parabola; in
/// contact the box would sink.
Vec3 missing_fall(const RigidBox& box, const RigidState& start, double step);
/// The end of such a step.
void add_gravity_and_drag(RigidBox& box, const Vec3& gravity, double step);

/// The same as printed: first v += a t, then p += v t; omega stays, of any box; the global damping
/// takes rho_g of both velocities in every step, whatever its length (3.1.3, ERRATA row 68).
void move_as_printed(RigidBox& box, const Vec3& gravity, double step);

}  // namespace pneuma::sim

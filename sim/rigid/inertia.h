// Moments of inertia of a box of uniform density (paper 4.1 with ERRATA row 8).
#pragma once

#include "sim/world/rigid_box.h"

namespace pneuma::sim {

/// The three principal moments in body axes, kg m^2: m/12 (h^2 + d^2, w^2 + d^2, w^2 + h^2) for
/// width, height and depth along x, y, z.
Vec3 body_inertia(const RigidBox& box);

/// R diag(I) R^T: the inertia in world axes, kg m^2.
Mat3 world_inertia(const RigidBox& box);

/// R diag(1/I) R^T: the inverse inertia in world axes (5.3), 1/(kg m^2); of a box that is turned
/// so.
Mat3 world_inverse_inertia(const RigidBox& box, const Eigen::Quaterniond& orientation);
Mat3 world_inverse_inertia(const RigidBox& box);

/// Angular momentum R diag(I) R^T omega about the box's own centre, kg m^2/s.
Vec3 spin(const RigidBox& box);

}  // namespace pneuma::sim

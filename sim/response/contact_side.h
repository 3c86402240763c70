// What an impulse meets on one side of a contact: one interface for soft features, rigid boxes and
// the ground, so that the impulse equation of section 5.3 is written once.
#pragma once

#include "sim/collision/contact.h"
#include "sim/world.h"

namespace pneuma::sim {

/// Velocity in m/s of a side's material at the contact point. A soft feature's is the mean over its
/// vertices, which have equal masses; a box's is v + omega x r (ERRATA row 19); the ground's is
/// zero.
Vec3 velocity_at(const World& world, const ContactSide& side, const Vec3& point);

/// How much velocity along the unit vector `direction`, in m/s, one N s along it gives at the
/// point: 1/m for a soft feature with the sum of its vertices' masses (5.3.1), 1/m + n . ((I^-1 (r
/// x n)) x r) for a box, 0 for the ground.
double inverse_mass_along(const World& world, const ContactSide& side, const Vec3& point,
                          const Vec3& direction);

/// Changes the side's velocities by an impulse in N s. All vertices of a soft feature change alike.
void apply_impulse(World& world, const ContactSide& side, const Vec3& point, const Vec3& impulse);

/// Moves the side's material by a displacement in m, without touching velocities.
void displace(World& world, const ContactSide& side, const Vec3& displacement);

/// Total mass a displacement is shared by: of a soft feature its vertices', infinite for the
/// ground.
double side_mass(const World& world, const ContactSide& side);

const Surface& surface(const World& world, const ContactSide& side);

}  // namespace pneuma::sim

// What contacts do as the paper prints it (3.1.4, 5.3): each is resolved once, one after the other
// (ERRATA rows 6, 29 to 31, 54 to 62 and 68).
#pragma once

#include <span>

#include "sim/response/contact_side.h"

namespace pneuma::sim {

/// One impulse with the factor epsilon + 1 for each contact. Between boxes it may have either sign;
/// elsewhere it only pushes. Vertices on the ground, and no others, get friction. The contacts get
/// their impulses. `masses` has one entry per box of the world.
void apply_printed_impulses(World& world, std::span<const BoxMass> masses,
                            std::span<Contact> contacts);

/// Moves vertices back to the ground, intersecting ones away from the triangle by the contact's
/// depth, and boxes away from each other. A box of which several corners intersect has moved from
/// where it was, in `box_positions`: what it moved along a contact's normal counts there.
void separate_as_printed(World& world, std::span<const Vec3> box_positions,
                         std::span<const Contact> contacts);

/// v_f = -mu v_par / |v_par| max(j, 0), added to the velocity: as printed, j in N s is taken for
/// m/s. The sliding may be reversed; what does not slide gets none.
Vec3 printed_friction(const Vec3& velocity, const Vec3& normal, double friction, double impulse);

}  // namespace pneuma::sim

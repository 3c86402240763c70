// Separating-plane test: whether a plane shows that two bodies whose bounding spheres overlap
// cannot touch (ERRATA row 39).
#pragma once

#include "sim/world/world.h"

namespace pneuma::sim {

/// Whether a plane at right angles to `direction` (from the first body towards the second, of any
/// length) keeps all vertices of the two more than `reach` (m) apart, where they are and where they
/// would be after `seconds` more with the velocities that they have. False without a direction.
bool has_separating_plane(const SoftBody& first, const SoftBody& second, const Vec3& direction,
                          double reach, double seconds);

}  // namespace pneuma::sim

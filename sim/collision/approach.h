// Whether two bodies whose bounding spheres overlap can touch at all.
#pragma once

#include "sim/world.h"

namespace pneuma::sim {

/// False if a plane at right angles to `direction` (from the first body towards the second, of any
/// length) keeps all vertices of the two more than `reach` (m) apart, where they are and where they
/// would be after `seconds` more with the velocities that they have. True without a direction.
bool may_touch(const SoftBody& first, const SoftBody& second, const Vec3& direction, double reach,
               double seconds);

}  // namespace pneuma::sim

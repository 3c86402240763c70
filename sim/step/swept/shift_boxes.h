// Boxes that are nearer to each other than they should be. Private to sim/step.
#pragma once

#include <algorithm>

#include "sim/step/swept/between_walls.h"
#include "sim/step/swept/swept_search.h"

namespace pneuma::sim {

/// What is nearer than half the distance wanted is moved apart, by this fraction of what is missing
/// in each step.
inline constexpr double closest_allowed = 0.5;
inline constexpr double made_up_per_step = 0.2;
/// m by which a contact is nearer than that; < 0: there is room.
inline double missing_distance(const SweptContact& contact) {
  return closest_allowed * contact.wanted - contact.distance;
}

/// Moves boxes apart besides their motion in the step (split impulses, as in Bullet), so that they
/// gain no velocity: velocities are never solved for so well, in a tall stack, that all of what
/// pushed would be taken back. The candidates must be known, and the boxes be at the end of their
/// free motion. `fraction`: of a whole step, which may have been halved. Whether any was moved.
bool shift_near_boxes(World& world, SweptMemory& memory, SweptSearch& search, double fraction);

/// Shifts keep the centre of mass of boxes that are near nothing but each other, but at different
/// velocities they change the angular momentum: it is given back as a rotation of all as one rigid
/// body, at the end of the step's motion. What that adds to their energy is taken from what they do
/// besides. Returns the work of both (J).
double keep_angular_momentum(World& world, SweptMemory& memory);

}  // namespace pneuma::sim

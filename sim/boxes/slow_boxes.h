// Energy that an impact of boxes must not add, taken from their motion.
#pragma once

#include <span>

#include "sim/world/rigid_box.h"

namespace pneuma::sim {

/// Takes energy (J, > 0) from the motion of boxes against each other: all of that shrinks by one
/// factor, so that what parts still parts, and linear and angular momentum stay as they are. Of
/// boxes that are held, whose momentum does not stay, all motion shrinks. Returns what was taken:
/// no more than there is.
double slow_boxes(std::span<RigidBox* const> boxes, bool are_held, double energy);

}  // namespace pneuma::sim

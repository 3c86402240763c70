// Energy that a step of the contact potential has added. Private to sim/step.
#pragma once

#include "sim/step/potential_step.h"

namespace pneuma::sim {

/// Takes `excess` (J, > 0) from what soft bodies do besides moving as rigid ones, and only if that
/// is not enough, from all motion: of bodies that touch only each other, from what they do besides
/// moving as one. Bodies that touch nothing give theirs only if that does not do. The world and
/// `memory.end` must be those of the end of the step.
void take_excess(World& world, PotentialMemory& memory, double excess);

}  // namespace pneuma::sim

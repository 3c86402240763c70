// Contacts add no energy to what they took. Private to sim/step.
#pragma once

#include "sim/step/swept/swept_memory.h"

namespace pneuma::sim {

/// What two boxes, or one and the ground, do to each other while nothing else takes part, follows
/// the path of their impulse (impact_path.h) in place of the solution, if it bounces and rubs.
void follow_impacts(SweptMemory& memory, double tolerance);

/// Newton's restitution can create energy, of bodies that turn or rub while they bounce: the speed
/// of one point does not say what two bodies have lost. So the contacts of an island do no work
/// above zero in a step in which any of them returns energy (restitution as a ratio of energies:
/// Stronge 1990). An island that would is solved again with nothing returned, and both solutions
/// are mixed. The energy is a convex function of the impulses, so that on the chord it is at most
/// what the chord says; Coulomb's cone is convex too.
///
/// Where the solver's iterations are too few, as for light vertices between heavy boxes, what they
/// leave may do any work. Impulses of an island that do work above zero, more than they could by
/// taking back those of the start, are shortened to the multiple of them that does least, if that
/// is less than nine tenths of them.
///
/// `memory`: the contacts and impulses of the end of the step, solved for to `tolerance` (m/s), and
/// of its start, with their work.
void limit_returned_energy(SweptMemory& memory, double tolerance);

}  // namespace pneuma::sim

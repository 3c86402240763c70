// Impacts of boxes that meet nothing else but a floor that they slide on (lone_pairs.h), at the
// moment at which they happen. Private to sim/step.
//
// The impulses of swept_step act at the start and at the end of a step, where boxes lie otherwise
// than in between: one that turns is hit with an arm that is off by what it turns in the step. So
// the step is cut for a box that hits the ground, or another box, and meets nothing else: they move
// freely, or along the floor, until then, get the impulse of the impact (impact_path.h) at the
// place where it happens, and move on freely. As in free motion, momentum and angular momentum are
// kept to rounding. A floor bears the weight of the whole step at its end, or until the impact
// lifts the box.
#pragma once

#include "sim/step/swept/contact_motion.h"
#include "sim/step/swept/swept_memory.h"

namespace pneuma::sim {

/// Once the impulses of the start are known and nothing crosses: takes back those of such impacts,
/// and of boxes that only pass each other; gives the boxes what the impacts give, books their work,
/// lists them in `memory.met_freely` and says of the contacts that they have met, and in
/// `memory.is_pushed` which bodies anything has pushed. Where that would bring a box too near
/// anything it leaves all as it is. Solves for velocities to `tolerance` (m/s). Returns false if it
/// has left an impact that bounces off by more than half of its speed and that would be found in
/// parts of this `fraction` of a step.
bool meet_freely(World& world, SweptMemory& memory, const MotionStart& start, double tolerance,
                 double fraction);

}  // namespace pneuma::sim

// Vertices of soft bodies that nothing but the ground can touch: of bodies that come near no other,
// and of others that have a part in no pair of features that may touch. They meet it each for
// itself (ERRATA rows 31, 67 and 70). What others can touch too and has sunk rises as far as these
// leave room. Private to sim/step.
#pragma once

#include "sim/step/swept/swept_search.h"

namespace pneuma::sim {

/// Resolves their contacts and appends these to `contacts`. Returns what that does to the energy,
/// J, if that is measured.
double resolve_alone_on_ground(World& world, const MotionStart& start, SweptSearch& search,
                               SweptMemory& memory, std::vector<Contact>& contacts);

/// Puts vertices that have a part in candidates, and that the step leaves below the ground, back
/// onto it, but nearer to what they may touch by less than half the distance to it: nothing passes
/// through what rises too. After resolve_alone_on_ground(), whose candidates it asks. Returns what
/// that does to the energy, J, if that is measured.
double lift_sunk_vertices(World& world, SweptMemory& memory);

/// Appends to `contacts`, which have all that contacts press, the vertices that an implicit
/// integrator holds on the ground itself, of bodies that do not meet it alone: without an impulse.
void list_held_on_ground(const World& world, const SweptMemory& memory,
                         std::vector<Contact>& contacts);

}  // namespace pneuma::sim

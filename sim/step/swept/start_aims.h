// What the impulses at the start of a step are solved for. Private to sim/step.
#pragma once

#include "sim/step/swept/swept_warm_start.h"

namespace pneuma::sim {

/// What the impulses at the start must still change, with the motion as it came out: what moved
/// the sides other than the impulses stays. Shifts are no motion: impulses do not resist them.
/// What friction let slip in earlier steps it takes back. `fraction`: of a step of the scene, if it
/// is divided: a part of it parts what is too near by no more speed than a whole one.
void aim_at_distances(const World& world, const MotionStart& start, SweptMemory& memory,
                      const SweptWarmStart& warm_start, double fraction);

}  // namespace pneuma::sim

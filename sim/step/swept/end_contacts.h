// The contacts at the end of a step: what touches then does not approach, or bounces. Private to
// sim/step.
#pragma once

#include "sim/step/swept/swept_warm_start.h"

namespace pneuma::sim {

/// Fills the memory's contacts and impulses, once those of the start (`first_contacts`) are solved
/// for and the bodies are where the step leaves them.
void find_end_contacts(const World& world, const MotionStart& start, SweptMemory& memory,
                       const SweptWarmStart& warm_start);

}  // namespace pneuma::sim

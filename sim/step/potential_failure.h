// How a step of the contact potential fails. Private to sim/step.
#pragma once

#include <string>

#include "sim/step/potential_step.h"

namespace pneuma::sim {

Divergence of_potential_step(const World& world, std::string body, std::string what);

/// Of a step that is not halved again: `limit` is on the way of `pair`, or of a vertex that comes
/// to the ground. `why`: of a way that nothing limits.
Divergence of_blocked_way(const World& world, const PotentialMemory& memory, const WayLimit& limit,
                          const ContactPair& pair, const std::string& why);
/// Of a box that turns too far in a step that is not halved again.
Divergence of_spinning_box(const World& world, const PotentialMemory& memory, int box);

}  // namespace pneuma::sim

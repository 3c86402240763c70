// How a step with swept contacts fails. Private to sim/step.
#pragma once

#include <optional>

#include "sim/step/stages/divergence.h"
#include "sim/step/swept/swept_memory.h"

namespace pneuma::sim {

/// At the start of a step: of the memory's contacts, that of a free box which something moved
/// presses deep into something else. It has no room left, and impulses would grow without end.
std::optional<Divergence> find_squeezed_box(const World& world, const SweptMemory& memory);

/// Of bodies that no part of a step keeps from passing through each other.
Divergence of_blocked_bodies(const World& world, const SweptBodies& bodies, const BodyPair& pair);
/// Of contacts that add `energy` (J), of which this has given most.
Divergence of_added_energy(const World& world, const SweptBodies& bodies,
                           const SweptContact& contact, double energy);

}  // namespace pneuma::sim

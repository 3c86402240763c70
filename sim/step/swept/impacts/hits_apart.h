// Impacts that parts of a step tell apart. Private to sim/step.
#pragma once

#include <span>

#include "sim/step/swept/contact_motion.h"
#include "sim/step/swept/swept_memory.h"

namespace pneuma::sim {

/// Of a step: impacts are told apart down to such parts.
inline constexpr double least_part = 1.0 / 32.0;

/// Whether a contact in which a box is hit is worth parts of a step: it bounces by more than half
/// of its speed, and is not slow.
bool bounces_well(const World& world, const ContactMotion& motion, const SweptContact& contact);
/// m/s: what is slower is not worth it.
double least_approach(const Settings& settings);
/// Whether the boxes that bounce, and lose by it, are few enough for it.
bool are_few(std::span<const Partner> boxes);
/// Whether all that have contacts are.
bool few_touch(std::span<const Partner> boxes);

/// Whether a box that moves freely is hit by two others, one after the other in the step, or by one
/// as it comes near another, and bounces off by more than half of its speed: by one impact of all
/// it would do otherwise. Of the contacts of the start or of those of the end; not of heaps,
/// nor in a `fraction` of a step that is too short for it.
bool is_hit_twice(const World& world, SweptMemory& memory, const ContactMotion& motion,
                  double fraction);

/// Whether a box that rests on what stands still tips onto another edge of it in the step, or as it
/// ends: its weight changes over then. Of the contacts of the end, and as above.
bool is_tipped_onto(const World& world, SweptMemory& memory, double fraction);

}  // namespace pneuma::sim

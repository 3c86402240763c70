// Boxes that walls on both sides leave less room than they would keep from each. Private to
// sim/step.
#pragma once

#include "sim/step/swept/contact_motion.h"
#include "sim/step/swept/swept_memory.h"

namespace pneuma::sim {

/// Of the distance wanted: what these keep. Twice what features keep on their ways
/// (SweptSearch::meets).
inline constexpr double kept_between_walls = 0.1;

/// Fills the memory's `between_walls`: a free box and a static or moved body that are nearer than
/// the distance wanted, where another such body is as near on the far side of the box. Of the
/// candidates.
void find_boxes_between_walls(const World& world, const ContactMotion& motion, SweptMemory& memory);

/// They touch no earlier than they must: with impulses at any distance, which nothing but friction
/// asks for, the box would stick to both walls.
bool is_between_walls(const SweptMemory& memory, const BodyPair& pair);

}  // namespace pneuma::sim

// Boxes between walls that leave less room than they would keep from both. Private to sim/step.
#pragma once

#include "sim/step/swept/contact_motion.h"
#include "sim/step/swept/swept_memory.h"

namespace pneuma::sim {

/// Of the distance wanted: what such a box keeps. Twice what features keep on their ways
/// (SweptSearch::meets).
inline constexpr double kept_between_walls = 0.1;

/// Fills the memory's `between_walls` from the candidates: the axes of free boxes along which what
/// is static or moved, or the ground, is on both sides, and leaves less room than the distance up
/// to which boxes are in contact. That is so or not wherever between them the box is.
void find_boxes_between_walls(const World& world, const ContactMotion& motion, SweptMemory& memory);

/// Whether one of two bodies is such a box and the other one of the walls, along the `normal` from
/// the second to the first. They touch no earlier than they must: with impulses at any distance,
/// which nothing but friction asks for, the box would stick to both walls.
bool is_between_walls(const World& world, const SweptMemory& memory, const BodyPair& bodies,
                      const Vec3& normal);
inline bool is_between_walls(const World& world, const SweptMemory& memory,
                             const SweptContact& contact) {
  return is_between_walls(world, memory, pair_of(contact), contact.normal);
}

/// m, by which a contact of such a box may come nearer.
inline double room_between_walls(const SweptContact& contact) {
  return contact.distance - kept_between_walls * contact.wanted;
}

}  // namespace pneuma::sim

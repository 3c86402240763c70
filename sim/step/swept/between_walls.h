// What boxes keep from walls that leave less room than they would keep from both, as SweptSearch
// finds them. Private to sim/step.
#pragma once

#include <optional>

#include "sim/step/swept/swept_memory.h"

namespace pneuma::sim {

/// Whether one of two bodies is such a box, and the other not the ground, whose contacts stay.
bool may_be_between_walls(const SweptMemory& memory, const BodyPair& bodies);

/// m, that two bodies keep of the distance `wanted` (m), if the other is one of the walls, or the
/// next box of a row between them, along the `normal` from the second to the first. They touch no
/// earlier than they must: with impulses at any distance, which nothing but friction asks for, the
/// box would stick to both walls. Where they would leave it no play, it may lie in them.
std::optional<double> kept_between_walls(const World& world, const SweptMemory& memory,
                                         const BodyPair& bodies, const Vec3& normal, double wanted);
inline std::optional<double> kept_between_walls(const World& world, const SweptMemory& memory,
                                                const SweptContact& contact) {
  return kept_between_walls(world, memory, pair_of(contact), contact.normal, contact.wanted);
}

/// The free one of two bodies, or the first of two, if walls squeeze it: boxes of which one is
/// moved, or such a box and the ground, that leave it no more room than it fills and do not slide
/// across each other; or -1.
int squeezed_box(const World& world, const SweptMemory& memory, const BodyPair& bodies);

/// Whether the other is beside it on the axis along which they do. Nothing moves it out of them.
bool is_squeezed(const World& world, const SweptMemory& memory, const BodyPair& bodies,
                 const Vec3& normal);

/// m, by which such walls leave less room than what is between them fills; 0 of other contacts.
double missing_room(const World& world, const SweptMemory& memory, const SweptContact& contact);

/// Such walls press the box, or the boxes of a row, in each contact between them: what is moved has
/// any force, and a rigid box does not say which. Tells the contact's impulse, of a step of so many
/// seconds, and the contact, if the walls nearly move as one: then less than that takes nothing
/// apart.
void squeeze_between_walls(const World& world, const SweptMemory& memory, double step,
                           SweptContact& contact, SweptImpulse& impulse);

}  // namespace pneuma::sim

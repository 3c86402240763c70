// The contacts of one island: impulses, friction and separation. Private to sim/step.
#pragma once

#include <span>
#include <utility>

#include "sim/step/stages/stage_memory.h"

namespace pneuma::sim {

/// Whether the contact is between boxes, or a box and the ground: one that can rest.
inline bool is_rigid(const Contact& contact) {
  return contact.first.kind == SideKind::rigid && contact.second.kind != SideKind::soft;
}

/// The boxes of a resting contact; with the ground, (-1, box). In this order contacts are found.
inline std::pair<int, int> boxes(const Contact& contact) {
  const bool on_ground = contact.second.kind == SideKind::ground;
  return on_ground ? std::pair(-1, contact.first.body)
                   : std::pair(contact.first.body, contact.second.body);
}

inline std::pair<int, int> boxes(const WarmStartImpulse& resting) {
  return resting.second < 0 ? std::pair(-1, resting.first)
                            : std::pair(resting.first, resting.second);
}

/// Where a resting contact acts, in the first box's own axes, m from its centre.
inline Vec3 point_on_first(const World& world, const Contact& contact) {
  const RigidBox& box = world.rigid[at(contact.first.body)];
  return box.orientation.conjugate() * (contact.point - box.position);
}

/// Stops the sides of the contacts of island `number`, lets them bounce, moves them apart. Islands
/// do not touch each other's vertices and boxes, nor each other's part of the memory. `start`: as
/// the step found the bodies.
void resolve_island(World& world, const MotionStart& start, std::span<const Contact> contacts,
                    int number, ResolveContactsMemory& memory);

}  // namespace pneuma::sim

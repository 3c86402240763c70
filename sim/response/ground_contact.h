// Vertices of soft bodies on the ground.
#pragma once

#include <span>
#include <vector>

#include "sim/collision/contact.h"
#include "sim/response/motion_start.h"

namespace pneuma::sim {

/// Puts the vertex of a contact back onto the ground (3.1.4). A vertex that friction holds is also
/// put where it would be if it had slowed down evenly over the step: left where the step's forces
/// carried it, it would creep down the gentlest slope (ERRATA row 30). `start`: as the step found
/// the vertex's body.
void put_onto_ground(World& world, const SoftState& start, const Contact& contact, bool sticks);

/// Resolves the contact of a vertex that touches the ground and nothing else (ERRATA row 31), which
/// gets its impulse.
void resolve_alone(World& world, const SoftState& start, Contact& contact);

/// Resolves all contacts of a soft body that touches the ground and nothing else: as resolve_alone,
/// but of explicit integrators what bounces does so when it meets the ground, and adds no energy
/// (ERRATA row 70). `before`: memory.
void resolve_on_ground(World& world, int soft, const SoftState& start, std::span<Contact> contacts,
                       VertexArray& before);

/// What an implicit integrator promises, contacts keep: a body that holds gas has a volume
/// (sim/response/keep_volume.h). `before`: the positions before its contacts were resolved.
void keep_volume(SoftBody& body, const VertexArray& before);

/// Finds and resolves the contacts of a soft body that touches the ground and nothing else.
/// Appends them to `contacts`. `before`: memory.
void meet_ground_alone(World& world, int soft, const SoftState& start,
                       std::vector<Contact>& contacts, VertexArray& before);

}  // namespace pneuma::sim

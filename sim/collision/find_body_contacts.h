// Contacts that rigid boxes take part in (paper 5.2.2, 5.2.3), and those with the ground.
#pragma once

#include <vector>

#include "sim/collision/contact.h"
#include "sim/world.h"

namespace pneuma::sim {

// Each appends to `contacts`. Indices are those of World::soft and World::rigid.

/// Vertices below the plane z = 0 (3.1.4).
void find_soft_ground(const World& world, int soft, std::vector<Contact>& contacts);

/// Corners below the plane z = 0.
void find_rigid_ground(const World& world, int rigid, std::vector<Contact>& contacts);

/// Vertices of the soft body inside the box, then corners of the box inside the soft body. Each is
/// to come out through the nearest face or triangle.
void find_soft_rigid(const World& world, int soft, int rigid, std::vector<Contact>& contacts);

/// The points in which two boxes touch along their axis of least penetration.
void find_rigid_rigid(const World& world, int first, int second, std::vector<Contact>& contacts);

}  // namespace pneuma::sim

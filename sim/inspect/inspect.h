// Read-only views of a world: what reports, tests and run.json say about it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/collision/contact.h"
#include "sim/inspect/overlap.h"
#include "sim/mesh/measure.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// Joule. The gas energy is -nRT ln(V / 1 m^3): only its differences mean anything.
struct Energy {
  double kinetic = 0.0;
  double spring = 0.0;  // of hinges, too
  double gas = 0.0;
  double gravity = 0.0;
  double contact = 0.0;  // of a world in which contact is a potential

  double total() const { return kinetic + spring + gas + gravity + contact; }
};

struct Momentum {
  Vec3 linear = Vec3::Zero();   // kg m/s
  Vec3 angular = Vec3::Zero();  // kg m^2/s about the world's origin
};

Energy energy(const World& world);
Energy energy(const SoftBody& body, const Vec3& gravity);
Energy energy(const RigidBox& box, const Vec3& gravity);
Momentum momentum(const World& world);
Momentum momentum(const SoftBody& body);

/// Bounding box of all bodies.
Bounds bounds(const World& world);

/// The maximal depth in metres by which, at this moment, a body reaches into the ground or into
/// another body; 0 when nothing overlaps. Of soft bodies the vertices and the middles of edges and
/// triangles count, of boxes the corners and four points along each edge, each by its distance from
/// the other body's surface; of two boxes the shortest way apart. The step itself keeps only
/// vertices and corners out (5.2.2), so that an edge may cut off a corner of another body. Looks at
/// all of this on bodies that are near each other: for reports, not for the step.
double max_penetration(const World& world);
/// The same with the bodies: soft ones first, then boxes; the second may be ground_body.
Overlap deepest_penetration(const World& world);

/// 64-bit hash of the whole state. Equal states, equal hashes, on one build.
std::uint64_t state_hash(const World& world);

}  // namespace pneuma::sim

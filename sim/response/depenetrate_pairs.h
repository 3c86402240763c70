// Soft bodies that lie deep in each other are moved apart as wholes, until they are clear
// (ERRATA row 64).
//
// Positions: each body is moved without touching its shape or its velocities, the two of a pair in
// opposite directions in inverse proportion to their masses, so that their common centre of mass
// stays. Kinetic, spring and gas energy do not change, and neither does that of gravity, which
// knows of the centre of mass only; nor does linear momentum. (Angular momentum does, if the bodies
// move across the way by which they are parted: as by every correction of positions, also 5.3.1's.)
// Above a ground they are parted along it: what one of them lost in height the ground would give
// back, out of nothing.
//
// Velocities: what brings the two centres nearer is stopped, by opposite impulses along the line
// between them that change all velocities of a body alike. Momentum, linear and angular, is kept,
// kinetic energy lost as where two lumps of clay meet; the springs feel nothing of it.
#pragma once

#include <span>
#include <vector>

#include "sim/collision/bounding_sphere.h"
#include "sim/collision/overlapping_pair.h"

namespace pneuma::sim {

/// Memory of depenetrate_pairs: what happens to each soft body. Contents mean nothing between
/// calls.
struct DepenetrationScratch {
  struct Body {
    bool overlaps = false;
    double inverse_mass = 0.0;           // 1/kg
    Vec3 start_velocity = Vec3::Zero();  // m/s, of the centre of mass
    Vec3 velocity = Vec3::Zero();        // m/s
    Vec3 way = Vec3::Zero();             // m, until it is clear of all others
    Vec3 asked = Vec3::Zero();           // m, by one iteration over all pairs
  };
  std::vector<Body> bodies;
};

/// `radii`: the farthest that a body is moved, in units of its radius; all bodies then go the same
/// fraction of their ways, also those that are in no heap with it. `spheres`: around the soft
/// bodies.
void depenetrate_pairs(World& world, std::span<const OverlappingPair> pairs, double radii,
                       std::span<const BoundingSphere> spheres, DepenetrationScratch& scratch);

}  // namespace pneuma::sim

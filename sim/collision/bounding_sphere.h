// Broad phase (section 5.1): spheres about bodies, and which of them overlap.
#pragma once

#include <span>
#include <vector>

#include "sim/collision/oriented_box.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/vertex_array.h"

namespace pneuma::sim {

struct BoundingSphere {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
};

/// About the centre of the bounding box, as in the paper, but out to the farthest vertex instead of
/// the box's corners: as safe, and up to a factor of sqrt(3) smaller (ERRATA row 38). `margin` (m)
/// is added to the radius: half the reach, so that bodies apart by less than the reach are found
/// (ERRATA row 10).
BoundingSphere bounding_sphere(const VertexArray& positions, double margin);
/// The same with the bounds at hand.
BoundingSphere bounding_sphere(const VertexArray& positions, const Bounds& bounds, double margin);
BoundingSphere bounding_sphere(const OrientedBox& box, double margin);

/// As printed: about the centre of the bounding box, out to its corners.
BoundingSphere printed_bounding_sphere(const Bounds& bounds);

bool overlap(const BoundingSphere& a, const BoundingSphere& b);
/// Whether they share a point, if only of their sides.
bool overlap(const Bounds& a, const Bounds& b);

/// Two bodies by index, first < second.
struct BodyPair {
  int first = 0;
  int second = 0;

  friend bool operator==(const BodyPair&, const BodyPair&) = default;
  friend bool operator<(const BodyPair& a, const BodyPair& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  }
};

}  // namespace pneuma::sim

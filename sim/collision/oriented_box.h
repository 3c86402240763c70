// A box anywhere in space, as the collision tests see a rigid body.
#pragma once

#include <array>
#include <optional>

#include "sim/mesh/measure.h"

namespace pneuma::sim {

struct OrientedBox {
  Vec3 centre = Vec3::Zero();
  Mat3 axes = Mat3::Identity();     // columns: the box's own unit axes in world coordinates
  Vec3 half = Vec3::Constant(0.5);  // half the lengths along them, m, > 0

  Vec3 to_local(const Vec3& point) const { return axes.transpose() * (point - centre); }
  Vec3 to_world(const Vec3& local) const { return centre + axes * local; }
  /// Corner i lies on the positive side of axis k when bit k of i is set.
  Vec3 corner(int i) const;
};

Bounds bounds(const OrientedBox& box);
/// All eight, by their numbers.
std::array<Vec3, 8> corners(const OrientedBox& box);

/// The point of the box, its inside as well, that is nearest to another.
Vec3 nearest_point(const OrientedBox& box, const Vec3& point);

/// How far inside a box a point is, and through which face it gets out soonest.
struct BoxExit {
  int face = 0;                // 2 k for the positive side of axis k, 2 k + 1 for the negative
  Vec3 normal = Vec3::Zero();  // outward unit normal of the face
  Vec3 point = Vec3::Zero();   // the nearest point of the face, m
  double depth = 0.0;          // m from there to the inside point
};

/// None for a point outside or on the surface.
std::optional<BoxExit> find_box_exit(const OrientedBox& box, const Vec3& point);

}  // namespace pneuma::sim

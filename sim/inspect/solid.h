// What a soft body and a rigid box have in common as sets of points: depth, bounds, surface points.
#pragma once

#include <functional>
#include <optional>

#include "sim/collision/oriented_box.h"
#include "sim/collision/triangle_columns.h"
#include "sim/inspect/closed_surface.h"

namespace pneuma::sim {

/// Of a point inside a solid.
struct DepthInside {
  double depth = 0.0;          // m from the surface
  Vec3 inward = Vec3::Zero();  // unit vector away from the nearest point of the surface
};

/// Refers to the soft body that it was made of.
class Solid {
 public:
  explicit Solid(const SoftBody& body);
  explicit Solid(const RigidBox& box);

  /// None for a soft body.
  const OrientedBox* box() const { return box_ ? &*box_ : nullptr; }

  /// Columns: of a box its own axes, of a soft body the principal axes of its vertices.
  const Mat3& axes() const { return axes_; }

  /// In coordinates along the given axes.
  Bounds bounds_along(const Mat3& axes) const;

  /// None for a point outside.
  std::optional<DepthInside> find_depth(const Vec3& point) const;

  /// Calls `look` with each vertex, the middle of each triangle and points of each edge: where it
  /// may be in `other`, at most an eighth of that one's least thickness apart, at most 16.
  void sample_surface(const Solid& other, const std::function<void(const Vec3&)>& look) const;

 private:
  ClosedSurface surface_;
  const SoftBody* body_ = nullptr;
  TriangleColumns columns_;  // of a soft body
  std::optional<OrientedBox> box_;
  Mat3 axes_ = Mat3::Identity();
};

}  // namespace pneuma::sim

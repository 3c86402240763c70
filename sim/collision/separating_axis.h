// The separating axis test of two boxes (section 5.2.3).
#pragma once

#include <optional>

#include "sim/collision/oriented_box.h"

namespace pneuma::sim {

enum class AxisKind { first_face, second_face, edges };

/// The axis of minimal overlap of two boxes: the shortest way apart.
struct MinOverlap {
  AxisKind kind = AxisKind::first_face;
  int first_axis = 0;          // of the first box: its face's normal, or its edge's direction
  int second_axis = 0;         // likewise of the second
  Vec3 normal = Vec3::Zero();  // unit; moving the first box along +normal takes it away
  double overlap = 0.0;        // m; moving it by more than this separates them; < 0: they are apart
};

/// None when an axis separates the boxes by more than `reach` (m); boxes that touch overlap by 0.
/// Of axes that are nearly as good a face of the first box is preferred to one of the second, and
/// either to a pair of edges, so that rounding does not decide between them: of boxes that overlap
/// `overlap` is at most (smallest + 0.001 * shortest half length) / 0.95 (ERRATA row 51).
std::optional<MinOverlap> find_min_overlap(const OrientedBox& first, const OrientedBox& second,
                                           double reach = 0.0);

/// m, from the centre of a box to the furthest that it reaches along a unit vector.
double radius_along(const OrientedBox& box, const Vec3& axis);

}  // namespace pneuma::sim

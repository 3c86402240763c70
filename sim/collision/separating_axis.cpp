#include "sim/collision/separating_axis.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {

namespace {

// Edges at less than this angle (its sine) give no axis of their own (ERRATA row 18). Leaving out
// an axis that would separate overlooks a gap of at most this share of the boxes' size.
constexpr double sine_of_parallel = 1e-10;

double radius_along(const OrientedBox& box, const Vec3& axis) {
  return (box.axes.transpose() * axis).cwiseAbs().dot(box.half);
}

/// Looks along one axis after the other until one separates the boxes.
class Search {
 public:
  Search(const OrientedBox& first, const OrientedBox& second)
      : first_(first), second_(second), offset_(first.centre - second.centre) {}

  /// False when the unit vector `axis` separates the boxes; else keeps the lesser overlap in
  /// `best`.
  bool look(const Vec3& axis, LeastOverlap axis_name, std::optional<LeastOverlap>& best) const {
    const double distance = offset_.dot(axis);
    const double overlap =
        radius_along(first_, axis) + radius_along(second_, axis) - std::abs(distance);
    if (overlap < 0.0) return false;
    if (!best || overlap < best->overlap) {
      axis_name.overlap = overlap;
      axis_name.normal = distance < 0.0 ? Vec3(-axis) : axis;
      best = axis_name;
    }
    return true;
  }

 private:
  const OrientedBox& first_;
  const OrientedBox& second_;
  Vec3 offset_;  // from the second box to the first
};

}  // namespace

// Two convex bodies are apart exactly when some axis separates them, and for polyhedra the faces'
// normals and the cross products of their edges are enough to try. The paper takes those of every
// triangle and edge; a box has only three of each that differ (ERRATA row 18), which leaves
// fifteen. Each axis is tested as the vector it is in floating point, so that even an inexact cross
// product of nearly parallel edges says nothing untrue.
std::optional<LeastOverlap> find_least_overlap(const OrientedBox& first,
                                               const OrientedBox& second) {
  const Search search(first, second);
  std::optional<LeastOverlap> first_face;
  std::optional<LeastOverlap> second_face;
  std::optional<LeastOverlap> edges;
  for (int i = 0; i < 3; ++i) {
    if (!search.look(first.axes.col(i), {AxisKind::first_face, i, 0}, first_face)) return {};
  }
  for (int j = 0; j < 3; ++j) {
    if (!search.look(second.axes.col(j), {AxisKind::second_face, 0, j}, second_face)) return {};
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Vec3 across = first.axes.col(i).cross(second.axes.col(j));
      const double sine = across.norm();
      if (sine < sine_of_parallel) continue;
      if (!search.look(across / sine, {AxisKind::edges, i, j}, edges)) return {};
    }
  }

  const double slack = 0.001 * std::min(first.half.minCoeff(), second.half.minCoeff());
  const auto clearly_less = [slack](const LeastOverlap& a, const LeastOverlap& b) {
    return a.overlap < 0.95 * b.overlap - slack;
  };
  std::optional<LeastOverlap> best = first_face;
  if (clearly_less(*second_face, *best)) best = second_face;
  if (edges && clearly_less(*edges, *best)) best = edges;
  return best;
}

}  // namespace pneuma::sim

#include "sim/collision/separating_axis.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/mesh/vec4d.h"

namespace pneuma::sim {

namespace {

// Edges at less than this angle (its sine) give no axis of their own (ERRATA row 18). Leaving out
// an axis that would separate overlooks a distance of at most this fraction of the boxes' size.
// Rounding turns the axis by up to its fraction over the sine, here 1e-6; that says nothing untrue,
// as overlaps are measured along the axis as it came out. Overlaps from RelativePose would be wrong
// by as much of the boxes' size, and only choose which axes to measure.
constexpr double sine_of_parallel = 1e-10;

// Of the boxes' size: far above the rounding of what RelativePose says of an edge axis, before it
// is divided by the sine.
constexpr double rounding_of_pose = 1e-13;

Vec4d absolute(Vec4d row) { return -min(row, -row); }

bool any_below(double limit, Vec4d row) {
  return row[0] < limit || row[1] < limit || row[2] < limit;
}

/// How the boxes lie, seen from each other: the axes of the second in the coordinates of the first
/// and the other way round (Ericson, Real-Time Collision Detection, 4.4.1, after Gottschalk).
struct RelativePose {
  Vec4d first_half, second_half;
  Mat3x4 second_axes, first_axes;
  Mat3x4 second_extents, first_extents;  // their absolute values
  Vec4d from_first, from_second;  // from the second box to the first, in the coordinates of either

  RelativePose(const OrientedBox& first, const OrientedBox& second)
      : first_half(to_vec4d(first.half)), second_half(to_vec4d(second.half)) {
    const Mat3x4 to_first = transposed(mat3x4(first.axes));
    for (int k = 0; k < 3; ++k) {
      second_axes.columns[at(k)] = to_first * to_vec4d(second.axes.col(k));
    }
    first_axes = transposed(second_axes);
    for (const std::size_t k : {0U, 1U, 2U}) {
      second_extents.columns[k] = absolute(second_axes.columns[k]);
      first_extents.columns[k] = absolute(first_axes.columns[k]);
    }
    from_first = to_first * (to_vec4d(first.centre) - to_vec4d(second.centre));
    from_second = first_axes * from_first;
  }

  /// By how much the boxes overlap along the normals of the first, and of the second.
  Vec4d along_first() const {
    return first_half + second_extents * second_half - absolute(from_first);
  }
  Vec4d along_second() const {
    return second_half + first_extents * first_half - absolute(from_second);
  }
};

/// Of the axes a_i x b_j for one i and every j.
struct EdgeAxes {
  Vec4d overlaps;  // times the sine
  Vec4d sines;
};

/// In the coordinates of the first box a_i is a unit vector, so that a_i x b_j has the two other
/// components of b_j, exchanged and one with its sign turned; likewise b_j x a_i in those of the
/// second.
EdgeAxes look_along_edges(const RelativePose& pose, std::size_t i) {
  const std::size_t k = (i + 1) % 3, m = (i + 2) % 3;
  const Vec4d along_k = pose.first_axes.columns[k], along_m = pose.first_axes.columns[m];
  const Vec4d first_reach =
      pose.first_half[k] * absolute(along_m) + pose.first_half[m] * absolute(along_k);
  const Vec4d extents = yzx(pose.first_extents.columns[i]), half = yzx(pose.second_half);
  const Vec4d second_reach = half * yzx(extents) + yzx(half) * extents;
  const Vec4d distance = pose.from_first[static_cast<int>(m)] * along_k -
                         pose.from_first[static_cast<int>(k)] * along_m;
  return {first_reach + second_reach - absolute(distance),
          square_root(along_k * along_k + along_m * along_m)};
}

int index_of_min(Vec4d row) {
  const int of_two = row[1] < row[0] ? 1 : 0;
  return row[2] < row[of_two] ? 2 : of_two;
}

MinOverlap min_along_first(const OrientedBox& first, const RelativePose& pose, Vec4d overlaps) {
  const int i = index_of_min(overlaps);
  const Vec3 axis = first.axes.col(i);
  return {AxisKind::first_face, i, 0, pose.from_first[i] < 0.0 ? Vec3(-axis) : axis, overlaps[i]};
}

MinOverlap min_along_second(const OrientedBox& second, const RelativePose& pose, Vec4d overlaps) {
  const int j = index_of_min(overlaps);
  const Vec3 axis = second.axes.col(j);
  return {AxisKind::second_face, 0, j, pose.from_second[j] < 0.0 ? Vec3(-axis) : axis, overlaps[j]};
}

/// Along the cross product of two edges as the vector it is in floating point, so that even an
/// inexact one of nearly parallel edges says nothing untrue. Seldom called, and kept out of the way
/// of what is looked at each time.
[[gnu::noinline]] MinOverlap overlap_of_edges(const OrientedBox& first, const OrientedBox& second,
                                              int i, int j) {
  const Vec3 axis = first.axes.col(i).cross(second.axes.col(j)).normalized();
  const double distance = (first.centre - second.centre).dot(axis);
  const double overlap =
      radius_along(first, axis) + radius_along(second, axis) - std::abs(distance);
  return {AxisKind::edges, i, j, distance < 0.0 ? Vec3(-axis) : axis, overlap};
}

}  // namespace

double radius_along(const OrientedBox& box, const Vec3& axis) {
  return (box.axes.transpose() * axis).cwiseAbs().dot(box.half);
}

// Two convex bodies are apart exactly when some axis separates them, and for polyhedra the faces'
// normals and the cross products of their edges are enough to try. The paper takes those of every
// triangle and edge; a box has only three of each that differ (ERRATA row 18), which leaves
// fifteen.
//
// Of the nine cross products few separate, and few beat the faces. Those that do neither are seen
// at a glance, without a division; only what may decide is looked at for itself.
std::optional<MinOverlap> find_min_overlap(const OrientedBox& first, const OrientedBox& second,
                                           double reach) {
  const RelativePose pose(first, second);
  const Vec4d along_first = pose.along_first(), along_second = pose.along_second();
  if (any_below(-reach, along_first) || any_below(-reach, along_second)) return {};

  const double slack = 0.001 * std::min(first.half.minCoeff(), second.half.minCoeff());
  const auto clearly_less_than = [slack](double overlap) {
    return (overlap < 0.0 ? 1.05 : 0.95) * overlap - slack;
  };
  MinOverlap best = min_along_first(first, pose, along_first);
  const MinOverlap of_second = min_along_second(second, pose, along_second);
  if (of_second.overlap < clearly_less_than(best.overlap)) best = of_second;

  // At -reach or more an axis does not separate, and from `limit` on it is not preferred either.
  double limit = clearly_less_than(best.overlap);
  const double rounding = rounding_of_pose * (first.half.sum() + second.half.sum());
  for (int i = 0; i < 3; ++i) {
    const auto [overlaps, sines] = look_along_edges(pose, at(i));
    const Vec4d surplus = overlaps - std::max(limit, -reach) * sines - rounding;
    if (!any_below(0.0, surplus)) continue;
    for (int j = 0; j < 3; ++j) {
      if (!(surplus[j] < 0.0) || sines[j] < sine_of_parallel) continue;
      const MinOverlap of_edges = overlap_of_edges(first, second, i, j);
      if (of_edges.overlap < -reach) return {};
      if (of_edges.overlap < limit) {
        best = of_edges;
        limit = of_edges.overlap;
      }
    }
  }
  return best;
}

}  // namespace pneuma::sim

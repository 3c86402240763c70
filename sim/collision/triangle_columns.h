// The triangles of a surface by where they lie seen from above, for rays along z.
#pragma once

#include <span>
#include <vector>

#include "sim/collision/surface_view.h"
#include "sim/mesh/measure.h"

namespace pneuma::sim {

/// Keeps its memory between fills.
class TriangleColumns {
 public:
  void fill(const SurfaceView& surface);

  /// Of the surface.
  const Bounds& bounds() const { return bounds_; }

  /// All triangles that the line through the point along z may meet, and a few more. Points outside
  /// the bounds get those of the column at their edge.
  std::span<const int> at_line_through(const Vec3& point) const {
    const std::size_t column = index_of(column_along(0, point.x()), column_along(1, point.y()));
    return std::span(entries_).subspan(at(starts_[column]),
                                       at(starts_[column + 1] - starts_[column]));
  }

  /// Calls visit(triangle) for all triangles that may come within `reach` (m) of the point, for
  /// some of them more than once.
  template <class Visit>
  void for_each_near(const Vec3& point, double reach, const Visit& visit) const {
    const int last_x = column_along(0, point.x() + reach);
    const int last_y = column_along(1, point.y() + reach);
    const int first_x = column_along(0, point.x() - reach);
    for (int y = column_along(1, point.y() - reach); y <= last_y; ++y) {
      const int end = starts_[index_of(last_x, y) + 1];
      for (int i = starts_[index_of(first_x, y)]; i < end; ++i) visit(entries_[at(i)]);
    }
  }

 private:
  int column_along(int axis, double coordinate) const;
  std::size_t index_of(int x, int y) const { return at(x + side_ * y); }

  Bounds bounds_;
  int side_ = 0;              // columns along x, and along y
  Vec3 per_metre_;            // columns
  Vec3 margin_;               // m, by which a triangle's box is widened
  std::vector<int> starts_;   // into entries_; one more than columns
  std::vector<int> entries_;  // triangles, column by column
};

}  // namespace pneuma::sim

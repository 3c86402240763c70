// The triangles of a surface by where they lie seen from above, for rays along z.
#pragma once

#include <vector>

#include "sim/collision/column_grid.h"
#include "sim/collision/surface_view.h"

namespace pneuma::sim {

/// Keeps its memory between fills.
class TriangleColumns {
 public:
  void fill(const SurfaceView& surface) { fill(surface, sim::bounds(surface.positions)); }
  /// The same with the surface's bounds at hand.
  void fill(const SurfaceView& surface, const Bounds& bounds);

  /// Of the surface.
  const Bounds& bounds() const { return grid_.bounds(); }

  /// A length (m) far above the rounding of where a line crosses a triangle, unless the surface is
  /// a million times its size away from the origin.
  double margin() const { return margin_.maxCoeff(); }

  /// Calls visit(triangle) for all triangles that the ray from a point along +z may cross, and a
  /// few more. The point within the bounds.
  template <class Visit>
  void for_each_above(const Vec3& point, const Visit& visit) const {
    for_each_at(point, [&](int triangle, const Box& box) {
      if (box.high[2] >= point.z() && box.is_crossed_at(point.x(), point.y())) visit(triangle);
    });
  }

  /// The same for the ray along -z.
  template <class Visit>
  void for_each_below(const Vec3& point, const Visit& visit) const {
    for_each_at(point, [&](int triangle, const Box& box) {
      if (box.low[2] <= point.z() && box.is_crossed_at(point.x(), point.y())) visit(triangle);
    });
  }

  /// Calls visit(triangle) for all triangles that may come within `reach` (m) of the point, for
  /// some of them more than once. What it returns is the reach from then on, at most what it was.
  template <class Visit>
  void for_each_near(const Vec3& point, double reach, const Visit& visit) const {
    const Vec4d centre = to_vec4d(point);
    const ColumnRange columns = grid_.range(centre - reach, centre + reach);
    for (int y = columns.first_y; y <= columns.last_y; ++y) {
      const int end = starts_[at(grid_.index_of(columns.last_x, y) + 1)];
      for (int i = starts_[at(grid_.index_of(columns.first_x, y))]; i < end; ++i) {
        const int triangle = entries_[at(i)];
        if (!boxes_[at(triangle)].is_beyond(centre, reach)) reach = visit(triangle);
      }
    }
  }

 private:
  /// About a triangle, a little wider.
  struct Box {
    Vec4d low, high;

    bool is_crossed_at(double x, double y) const {
      return low[0] <= x && x <= high[0] && low[1] <= y && y <= high[1];
    }
    /// Whether it is farther from the point than `reach` along some axis.
    bool is_beyond(Vec4d point, double reach) const {
      const Vec4d way_in = min(point - low, high - point) + reach;
      return way_in[0] < 0.0 || way_in[1] < 0.0 || way_in[2] < 0.0;
    }
  };

  template <class Visit>
  void for_each_at(const Vec3& point, const Visit& visit) const {
    const int column = grid_.at_point(to_vec4d(point));
    for (int i = starts_[at(column)]; i < starts_[at(column + 1)]; ++i) {
      const int triangle = entries_[at(i)];
      visit(triangle, boxes_[at(triangle)]);
    }
  }
  void measure(const SurfaceView& surface);
  template <class Visit>
  void for_each_line(const Visit& visit) const;

  ColumnGrid grid_;
  Vec3 margin_ = Vec3::Zero();       // m, by which a triangle's box is widened
  std::vector<Box> boxes_;           // per triangle
  std::vector<ColumnRange> ranges_;  // per triangle
  std::vector<int> starts_;          // into entries_; one more than columns
  std::vector<int> entries_;         // triangles, column by column
};

}  // namespace pneuma::sim

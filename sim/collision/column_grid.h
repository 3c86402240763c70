// Columns along z over the bounds of a surface, seen from above: a square of them.
#pragma once

#include <bit>

#include "sim/mesh/measure.h"
#include "sim/mesh/vec4d.h"

namespace pneuma::sim {

/// From the first to the last column along x and y, both included.
struct ColumnRange {
  int first_x, first_y, last_x, last_y;
};

/// Coordinates outside the bounds belong to the columns at their edge.
class ColumnGrid {
 public:
  ColumnGrid() = default;
  /// `side` columns along x and along y, >= 1.
  ColumnGrid(const Bounds& bounds, int side) : bounds_(bounds), side_(side) {
    const Vec3 size = bounds.size();
    const double x = size.x() > 0.0 ? side / size.x() : 0.0;
    const double y = size.y() > 0.0 ? side / size.y() : 0.0;
    per_metre_ = Vec4d{x, y, x, y};
    origin_ = Vec4d{bounds.low.x(), bounds.low.y(), bounds.low.x(), bounds.low.y()};
  }

  const Bounds& bounds() const { return bounds_; }
  int count() const { return side_ * side_; }
  int index_of(int x, int y) const { return x + side_ * y; }

  /// The columns that a box from low to high reaches into.
  ColumnRange range(Vec4d low, Vec4d high) const {
    typedef int Integers __attribute__((vector_size(16)));
    const Vec4d last = Vec4d{} + (side_ - 1.0);
    const Vec4d corners = __builtin_shufflevector(low, high, 0, 1, 4, 5);
    const Vec4d columns = max(min((corners - origin_) * per_metre_, last), Vec4d{});
    return std::bit_cast<ColumnRange>(__builtin_convertvector(columns, Integers));
  }

  /// The column that a point lies in.
  int at_point(Vec4d point) const {
    const ColumnRange here = range(point, point);
    return index_of(here.first_x, here.first_y);
  }

 private:
  Bounds bounds_;
  int side_ = 1;
  Vec4d per_metre_{};  // columns, along x, y, x, y
  Vec4d origin_{};     // m, likewise
};

}  // namespace pneuma::sim

// Triangles with corners on a grid, and whether two of them touch: free of rounding.
#pragma once

#include <array>

#include "sim/base/exact.h"
#include "sim/mesh/triangle_mesh.h"

namespace pneuma::assets {

struct GridTriangle {
  sim::Triangle vertices;  // two triangles share the corners whose vertices have equal numbers
  std::array<base::GridPoint, 3> corners;
};

/// A box of the grid with its sides along the axes.
struct GridBox {
  base::GridPoint low = {base::grid_steps, base::grid_steps, base::grid_steps};
  base::GridPoint high = {-base::grid_steps, -base::grid_steps, -base::grid_steps};

  void include(const GridBox& other);
  /// Whether they share a point, if only of their sides.
  bool overlaps(const GridBox& other) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (low[i] > other.high[i] || other.low[i] > high[i]) return false;
    }
    return true;
  }
};

GridBox box_of(const GridTriangle& triangle);

/// Whether the corners are on one line.
bool is_flat(const GridTriangle& triangle);

/// Whether two triangles, which are not flat, have more in common than the corners and sides that
/// they share.
bool touch(const GridTriangle& a, const GridTriangle& b);

}  // namespace pneuma::assets

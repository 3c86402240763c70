// The vertices of a surface by where they lie seen from above.
#pragma once

#include <vector>

#include "sim/collision/column_grid.h"
#include "sim/mesh/vertex_array.h"

namespace pneuma::sim {

/// Keeps its memory between fills.
class VertexColumns {
 public:
  void fill(const VertexArray& positions, const Bounds& bounds);

  /// Calls visit(vertex) once for all vertices within a region, and for some that are near to it,
  /// column by column: in no order of their numbers.
  template <class Visit>
  void for_each_near(const Bounds& region, const Visit& visit) const {
    const ColumnRange columns = grid_.range(to_vec4d(region.low), to_vec4d(region.high));
    for (int y = columns.first_y; y <= columns.last_y; ++y) {
      const int end = starts_[at(grid_.index_of(columns.last_x, y) + 1)];
      for (int i = starts_[at(grid_.index_of(columns.first_x, y))]; i < end; ++i) {
        visit(vertices_[at(i)]);
      }
    }
  }

 private:
  ColumnGrid grid_;
  std::vector<int> columns_;   // per vertex
  std::vector<int> starts_;    // into vertices_; one more than columns
  std::vector<int> vertices_;  // column by column
};

}  // namespace pneuma::sim

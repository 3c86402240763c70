#include "sim/collision/vertex_columns.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {

// As many columns as vertices, or a few less. Counting sort: how many each column has, where they
// end, and the vertices from the back, the last one first.
void VertexColumns::fill(const VertexArray& positions, const Bounds& bounds) {
  const int count = positions.size();
  grid_ = ColumnGrid(bounds, std::max(1, static_cast<int>(std::sqrt(count))));
  const VertexReader read(positions);
  columns_.resize(at(count));
  starts_.assign(at(grid_.count() + 1), 0);
  for (int v = 0; v < count; ++v) {
    columns_[at(v)] = grid_.at_point(read[v]);
    ++starts_[at(columns_[at(v)])];
  }
  int end = 0;
  for (int& start : starts_) start = (end += start);
  vertices_.resize(at(count));
  for (int v = count - 1; v >= 0; --v) vertices_[at(--starts_[at(columns_[at(v)])])] = v;
}

}  // namespace pneuma::sim

#include "assets/simplify/grid_triangle.h"

#include <algorithm>

namespace pneuma::assets {
namespace {

bool has_vertex(const GridTriangle& triangle, int vertex) {
  return std::ranges::find(triangle.vertices, vertex) != triangle.vertices.end();
}

/// The corners that it shares with the other come first, and their number.
int put_shared_first(GridTriangle& triangle, const GridTriangle& other) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!has_vertex(other, triangle.vertices[i])) continue;
    std::swap(triangle.vertices[i], triangle.vertices[count]);
    std::swap(triangle.corners[i], triangle.corners[count]);
    ++count;
  }
  return static_cast<int>(count);
}

/// The first `count` sides of a, from the one opposite to its first corner on, against b.
bool any_side_meets(const GridTriangle& a, const GridTriangle& b, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    if (base::segment_meets_triangle(a.corners[(i + 1) % 3], a.corners[(i + 2) % 3], b.corners[0],
                                     b.corners[1], b.corners[2])) {
      return true;
    }
  }
  return false;
}

}  // namespace

void GridBox::include(const GridBox& other) {
  for (std::size_t i = 0; i < 3; ++i) {
    low[i] = std::min(low[i], other.low[i]);
    high[i] = std::max(high[i], other.high[i]);
  }
}

GridBox box_of(const GridTriangle& triangle) {
  GridBox box;
  for (const base::GridPoint& corner : triangle.corners) box.include({corner, corner});
  return box;
}

bool is_flat(const GridTriangle& triangle) {
  return base::on_one_line(triangle.corners[0], triangle.corners[1], triangle.corners[2]);
}

bool touch(const GridTriangle& first, const GridTriangle& second) {
  GridTriangle a = first, b = second;
  put_shared_first(a, second);
  switch (put_shared_first(b, first)) {
    case 0:
      return any_side_meets(a, b, 3) || any_side_meets(b, a, 3);
    case 1:  // beyond the shared vertex only if the side opposite to it meets the other triangle
      return any_side_meets(a, b, 1) || any_side_meets(b, a, 1);
    case 2:  // beyond the shared side only if they lie on each other
      return base::side_of_plane(a.corners[0], a.corners[1], a.corners[2], b.corners[2]) == 0 &&
             base::same_side_of_edge(a.corners[0], a.corners[1], a.corners[2], b.corners[2]);
    default:
      return true;
  }
}

}  // namespace pneuma::assets

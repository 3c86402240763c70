#include "sim/collision/triangle_columns.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {
namespace {

/// Triangles per column, were they spread evenly.
constexpr double mean_load = 4.0;

/// Of the surface's size: far above the rounding of where an edge passes a plane, by which a
/// crossing may lie outside the box of its triangle.
constexpr double widening = 1e-9;

/// Room for so many entries per triangle is made at once: small triangles lie in one to four
/// columns, and the number changes as the surface moves.
constexpr int reserved_per_triangle = 8;

}  // namespace

void TriangleColumns::fill(const SurfaceView& surface, const Bounds& bounds) {
  const int triangles = surface.topology.triangle_count();
  grid_ = ColumnGrid(bounds, std::max(1, static_cast<int>(std::sqrt(triangles / mean_load))));
  margin_ = widening * bounds.size();
  measure(surface);
  // Counting sort: by how many entries each column has more than the one before it, where they end,
  // and the entries from the back.
  starts_.assign(at(grid_.count() + 1), 0);
  for_each_line([&](int first, int last, int) {
    ++starts_[at(first)];
    --starts_[at(last + 1)];
  });
  int load = 0, end = 0;
  for (int& start : starts_) start = (end += (load += start));
  entries_.reserve(at(reserved_per_triangle * triangles));
  entries_.resize(at(end));
  for_each_line([&](int first, int last, int t) {
    for (int column = first; column <= last; ++column) entries_[at(--starts_[at(column)])] = t;
  });
}

/// The box and the columns of each triangle.
void TriangleColumns::measure(const SurfaceView& surface) {
  const std::vector<Triangle>& triangles = surface.topology.triangles();
  const VertexReader positions(surface.positions);
  const Vec4d margin = to_vec4d(margin_);
  boxes_.resize(triangles.size());
  ranges_.resize(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [first, second, third] = triangles[t];
    const Vec4d a = positions[first], b = positions[second], c = positions[third];
    const Vec4d low = min(min(a, b), c) - margin;
    const Vec4d high = max(max(a, b), c) + margin;
    boxes_[t] = {low, high};
    ranges_[t] = grid_.range(low, high);
  }
}

/// Calls visit(first, last, triangle) for the columns of each triangle, line by line of them.
template <class Visit>
void TriangleColumns::for_each_line(const Visit& visit) const {
  for (int t = 0; t < static_cast<int>(ranges_.size()); ++t) {
    const auto [first_x, first_y, last_x, last_y] = ranges_[at(t)];
    for (int y = first_y; y <= last_y; ++y) {
      visit(grid_.index_of(first_x, y), grid_.index_of(last_x, y), t);
    }
  }
}

}  // namespace pneuma::sim

#include "sim/collision/triangle_columns.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {
namespace {

/// Triangles per column, were they spread evenly.
constexpr double mean_load = 2.0;

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
  // Counting sort: how many each column has, where they end, and the entries from the back.
  starts_.assign(at(grid_.count() + 1), 0);
  for_each_entry([&](int column, int) { ++starts_[at(column)]; });
  int end = 0;
  for (int& start : starts_) start = (end += start);
  entries_.reserve(at(reserved_per_triangle * triangles));
  entries_.resize(at(end));
  for_each_entry([&](int column, int t) { entries_[at(--starts_[at(column)])] = t; });
}

/// The box and the columns of each triangle.
void TriangleColumns::measure(const SurfaceView& surface) {
  const std::vector<Triangle>& triangles = surface.topology.triangles();
  const RowReader positions(surface.positions);
  const Row margin = to_row(margin_);
  boxes_.resize(triangles.size());
  ranges_.resize(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [first, second, third] = triangles[t];
    const Row a = positions[first], b = positions[second], c = positions[third];
    const Row low = lesser(lesser(a, b), c) - margin;
    const Row high = margin - lesser(lesser(-a, -b), -c);
    boxes_[t] = {low, high};
    ranges_[t] = grid_.range(low, high);
  }
}

/// Calls visit(column, triangle) for all columns of each triangle.
template <class Visit>
void TriangleColumns::for_each_entry(const Visit& visit) const {
  for (int t = 0; t < static_cast<int>(ranges_.size()); ++t) {
    const auto [first_x, first_y, last_x, last_y] = ranges_[at(t)];
    for (int y = first_y; y <= last_y; ++y) {
      for (int x = first_x; x <= last_x; ++x) visit(grid_.index_of(x, y), t);
    }
  }
}

}  // namespace pneuma::sim

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

void TriangleColumns::fill(const SurfaceView& surface) {
  const MeshTopology& topology = surface.topology;
  bounds_ = sim::bounds(surface.positions);
  side_ = std::max(1, static_cast<int>(std::sqrt(topology.triangle_count() / mean_load)));
  const Vec3 size = bounds_.size();
  for (int axis = 0; axis < 3; ++axis)
    per_metre_[axis] = size[axis] > 0.0 ? side_ / size[axis] : 0.0;
  margin_ = widening * size;

  const auto for_each_entry = [&](const auto& visit) {
    for (int t = 0; t < topology.triangle_count(); ++t) {
      const auto& [a, b, c] = topology.triangles()[at(t)];
      const Vec3 pa = surface.positions[a], pb = surface.positions[b], pc = surface.positions[c];
      const Vec3 low = pa.cwiseMin(pb).cwiseMin(pc) - margin_;
      const Vec3 high = pa.cwiseMax(pb).cwiseMax(pc) + margin_;
      const int last_x = column_along(0, high.x()), last_y = column_along(1, high.y());
      for (int y = column_along(1, low.y()); y <= last_y; ++y) {
        for (int x = column_along(0, low.x()); x <= last_x; ++x) visit(index_of(x, y), t);
      }
    }
  };
  // Counting sort: how many each column has, where they end, and the entries from the back.
  starts_.assign(at(side_ * side_ + 1), 0);
  for_each_entry([&](std::size_t column, int) { ++starts_[column]; });
  int end = 0;
  for (int& start : starts_) start = (end += start);
  entries_.reserve(at(reserved_per_triangle * topology.triangle_count()));
  entries_.resize(at(end));
  for_each_entry([&](std::size_t column, int t) { entries_[at(--starts_[column])] = t; });
}

int TriangleColumns::column_along(int axis, double coordinate) const {
  const double column = (coordinate - bounds_.low[axis]) * per_metre_[axis];
  return std::clamp(static_cast<int>(column), 0, side_ - 1);
}

}  // namespace pneuma::sim

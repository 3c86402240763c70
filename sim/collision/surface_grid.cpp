#include "sim/collision/surface_grid.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {
namespace {

/// Along a side, so that a body with a few very small triangles does not fill the memory.
constexpr int max_cells = 64;

bool meet(const Bounds& a, const Bounds& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

/// The number of cells goes up and down as the bodies move: room for twice as many saves an
/// allocation at each new peak.
void reserve_ahead(std::vector<int>& values, std::size_t count) {
  if (values.capacity() < count) values.reserve(2 * count);
}

}  // namespace

void SurfaceGrid::fill(const SurfaceView& surface, const Bounds& region) {
  region_ = region;
  taken_.clear();
  boxes_.clear();
  double extent = 0.0;
  for (int t = 0; t < surface.topology.triangle_count(); ++t) {
    Bounds box;
    for (const Vec3& corner : triangle_corners(surface, t)) box.include(corner);
    if (!meet(box, region)) continue;
    taken_.push_back(t);
    boxes_.push_back(box);
    extent += box.size().maxCoeff();
  }
  if (taken_.empty()) {
    cell_start_.clear();
    return;
  }
  last_query_.resize(std::max(last_query_.size(), taken_.size()), 0);
  choose_cells(extent / static_cast<double>(taken_.size()));

  // Counting sort: how many entries each cell has, where they start, and the entries.
  const std::size_t cells = at(counts_.prod());
  reserve_ahead(cell_start_, cells + 1);
  cell_start_.assign(cells + 1, 0);
  const auto for_each_entry = [&](const auto& visit) {
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      const auto [low, high] = cells_of(boxes_[i]);
      for (int z = low[2]; z <= high[2]; ++z) {
        for (int y = low[1]; y <= high[1]; ++y) {
          for (int x = low[0]; x <= high[0]; ++x) visit(index_of(x, y, z), static_cast<int>(i));
        }
      }
    }
  };
  for_each_entry([&](std::size_t cell, int) { ++cell_start_[cell]; });
  int end = 0;
  for (int& start : cell_start_) start = (end += start);  // now where each cell ends
  reserve_ahead(entries_, at(end));
  entries_.resize(at(end));
  for_each_entry([&](std::size_t cell, int taken) { entries_[at(--cell_start_[cell])] = taken; });
}

void SurfaceGrid::choose_cells(double mean_extent) {
  const Vec3 size = region_.size();
  for (int axis = 0; axis < 3; ++axis) {
    const double wanted = mean_extent > 0.0 ? size[axis] / mean_extent : 1.0;
    counts_[axis] = static_cast<int>(std::clamp(std::ceil(wanted), 1.0, double{max_cells}));
    inverse_cell_[axis] = size[axis] > 0.0 ? counts_[axis] / size[axis] : 0.0;
  }
}

SurfaceGrid::CellRange SurfaceGrid::cells_of(const Bounds& box) const {
  const auto cell_of = [&](const Vec3& point) -> Cell {
    const Eigen::Array3d cell = ((point - region_.low).array() * inverse_cell_).floor();
    return cell.max(0.0).min((counts_ - 1).cast<double>()).cast<int>();
  };
  return {cell_of(box.low), cell_of(box.high)};
}

}  // namespace pneuma::sim

// Spatial subdivision: the triangles of a surface in a region, sorted into cells, so that those
// near a point are found without looking at all (the paper's section 7 asks for it; ERRATA row 45).
#pragma once

#include <cstdint>
#include <vector>

#include "sim/collision/surface_view.h"
#include "sim/mesh/measure.h"

namespace pneuma::sim {

/// Keeps its memory between fills, so that nothing is allocated once numbers have peaked.
class SurfaceGrid {
 public:
  /// Takes the triangles whose boxes meet `region`, which must be finite and not empty. The surface
  /// must outlive the queries.
  void fill(const SurfaceView& surface, const Bounds& region);

  /// Calls visit(triangle, its box) once for every triangle taken whose box may meet `box`, among
  /// them all whose box does, in an order that depends on the surface, the region and `box` only.
  template <class Visit>
  void for_each_near(const Bounds& box, const Visit& visit) {
    if (cell_start_.empty()) return;
    ++query_;
    const auto [low, high] = cells_of(box);
    for (int z = low[2]; z <= high[2]; ++z) {
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int x = low[0]; x <= high[0]; ++x) {
          const std::size_t cell = index_of(x, y, z);
          for (int i = cell_start_[cell]; i < cell_start_[cell + 1]; ++i) {
            const std::size_t taken = at(entries_[at(i)]);
            if (last_query_[taken] == query_) continue;
            last_query_[taken] = query_;
            visit(taken_[taken], boxes_[taken]);
          }
        }
      }
    }
  }

 private:
  using Cell = Eigen::Array3i;
  struct CellRange {
    Cell low;
    Cell high;
  };

  void choose_cells(double mean_extent);
  /// Beyond the region, the cells at its edge.
  CellRange cells_of(const Bounds& box) const;
  std::size_t index_of(int x, int y, int z) const {
    return at(x + counts_[0] * (y + counts_[1] * z));
  }

  Bounds region_;
  Cell counts_ = Cell::Ones();             // cells along x, y, z
  Eigen::Array3d inverse_cell_;            // 1/m
  std::vector<int> taken_;                 // triangles that meet the region
  std::vector<Bounds> boxes_;              // of those
  std::vector<int> cell_start_;            // into entries_; one more than cells
  std::vector<int> entries_;               // indices into taken_, cell by cell
  std::vector<std::uint64_t> last_query_;  // that visited it, per triangle taken
  std::uint64_t query_ = 0;
};

}  // namespace pneuma::sim

#include "assets/weld.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace pneuma::assets {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t number : cell) {
      // Fibonacci hashing with a shift, so that neighbouring cells do not collide in rows.
      hash = (hash ^ static_cast<std::uint64_t>(number)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    return hash;
  }
};

/// Kept vertices by cells of twice the distance: what is near a point lies in at most eight.
class Grid {
 public:
  Grid(const std::vector<Vec3>& kept, double distance, std::size_t expected)
      : kept_(kept), distance_(distance) {
    cells_.reserve(expected);
  }

  /// The lowest kept vertex near the point, or -1.
  int find(const Vec3& point) const {
    const Cell low = cell_of(point - Vec3::Constant(distance_));
    const Cell high = cell_of(point + Vec3::Constant(distance_));
    int found = -1;
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z)
          found = nearer_index(found, {x, y, z}, point);
      }
    }
    return found;
  }

  void insert(int index) { cells_[cell_of(kept_[sim::at(index)])].push_back(index); }

 private:
  Cell cell_of(const Vec3& point) const {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
      cell[sim::at(axis)] = static_cast<std::int64_t>(std::floor(point[axis] / (2.0 * distance_)));
    }
    return cell;
  }

  int nearer_index(int found, const Cell& cell, const Vec3& point) const {
    const auto members = cells_.find(cell);
    if (members == cells_.end()) return found;
    for (const int index : members->second) {
      if (found >= 0 && index >= found) break;
      if ((kept_[sim::at(index)] - point).squaredNorm() <= distance_ * distance_) return index;
    }
    return found;
  }

  const std::vector<Vec3>& kept_;
  double distance_;
  std::unordered_map<Cell, std::vector<int>, CellHash> cells_;
};

}  // namespace

Weld weld(const std::vector<Vec3>& vertices, double distance) {
  Weld result;
  result.new_index.reserve(vertices.size());
  if (vertices.empty()) return result;
  const Vec3 origin = vertices.front();  // cells count from here, whatever the model's place
  std::vector<Vec3> kept;
  Grid grid(kept, distance, vertices.size());
  for (const Vec3& vertex : vertices) {
    int index = grid.find(vertex - origin);
    if (index < 0) {
      index = static_cast<int>(kept.size());
      kept.push_back(vertex - origin);
      result.vertices.push_back(vertex);
      grid.insert(index);
    }
    result.new_index.push_back(index);
  }
  return result;
}

}  // namespace pneuma::assets

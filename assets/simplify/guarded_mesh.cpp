#include "assets/simplify/guarded_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/mesh/measure.h"

namespace pneuma::assets {
namespace {

using sim::at;
using sim::Triangle;

constexpr double steps_per_extent = static_cast<double>(base::grid_steps);
/// Of the grid, from its middle along each axis: the surface takes half of it, and what replaces a
/// part of it may lie a little outside.
constexpr double reach = 0.75;
constexpr double edges_per_cell = 2.0;
constexpr int most_cells_along = 100;

base::GridPoint grid_point(const Vec3& position) {
  base::GridPoint point;
  for (int axis = 0; axis < 3; ++axis) {
    point[at(axis)] = std::llround(position[axis] * steps_per_extent);
  }
  return point;
}

sim::Bounds bounds_of(const sim::TriangleMesh& mesh) {
  sim::Bounds box;
  for (const Vec3& vertex : mesh.vertices) box.include(vertex);
  return box;
}

sim::TriangleMesh in_extents(sim::TriangleMesh mesh, const Vec3& centre, double extent) {
  for (Vec3& vertex : mesh.vertices) vertex = GuardedMesh::on_grid((vertex - centre) / extent);
  return mesh;
}

}  // namespace

Vec3 GuardedMesh::on_grid(const Vec3& place) {
  const auto [x, y, z] = grid_point(place);
  return Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)) /
         steps_per_extent;
}

bool GuardedMesh::is_on_grid(const Vec3& place) {
  return place.allFinite() && place.cwiseAbs().maxCoeff() <= reach;
}

GuardedMesh::GuardedMesh(sim::TriangleMesh mesh, double edge)
    : mesh_(in_extents(mesh, bounds_of(mesh).centre(), bounds_of(mesh).size().maxCoeff())),
      centre_(bounds_of(mesh).centre()),
      extent_(bounds_of(mesh).size().maxCoeff()),
      last_look_(mesh.triangles.size(), 0) {
  for (int v = 0; v < mesh_.vertex_count(); ++v) points_.push_back(grid_point(position(v)));
  const double along = extent_ / (edges_per_cell * edge);
  cells_along_ = along < most_cells_along ? std::max(1, static_cast<int>(along)) : most_cells_along;
  cells_.resize(at(cells_along_) * at(cells_along_) * at(cells_along_));
  std::vector<int> all(mesh.triangles.size());
  for (std::size_t t = 0; t < all.size(); ++t) all[t] = static_cast<int>(t);
  enter(all);
}

bool GuardedMesh::stays_apart(std::span<const int> before, std::span<const Triangle> now,
                              int vertex, const Vec3& place) {
  const base::GridPoint point = grid_point(place);
  GridBox whole;
  now_.clear();
  for (const Triangle& triangle : now) {
    GridTriangle& added = now_.emplace_back(grid_triangle(triangle));
    for (std::size_t i = 0; i < 3; ++i) {
      if (triangle[i] == vertex) added.corners[i] = point;
    }
    if (is_flat(added)) return false;
    whole.include(box_of(added));
  }
  for (std::size_t i = 0; i < now_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (touch(now_[i], now_[j])) return false;
    }
  }
  find_near(whole, before);
  for (const GridTriangle& added : now_) {
    const GridBox box = box_of(added);
    for (const GridTriangle& other : near_) {
      if (box.overlaps(box_of(other)) && touch(added, other)) return false;
    }
  }
  return true;
}

void GuardedMesh::collapse(int a, int b, const Vec3& place) {
  leave(mesh_.triangles_at(a));
  leave(mesh_.triangles_at(b));
  mesh_.collapse(a, b, place);
  points_[at(a)] = grid_point(place);
  enter(mesh_.triangles_at(a));
}

void GuardedMesh::flip(int a, int b) {
  const std::array<int, 2> changed = mesh_.sides(a, b);
  leave(changed);
  mesh_.flip(a, b);
  enter(changed);
}

void GuardedMesh::move(int vertex, const Vec3& place) {
  leave(mesh_.triangles_at(vertex));
  mesh_.position(vertex) = place;
  points_[at(vertex)] = grid_point(place);
  enter(mesh_.triangles_at(vertex));
}

sim::TriangleMesh GuardedMesh::result() const {
  sim::TriangleMesh mesh = mesh_.compact();
  for (Vec3& vertex : mesh.vertices) vertex = centre_ + extent_ * vertex;
  return mesh;
}

GridTriangle GuardedMesh::grid_triangle(const Triangle& triangle) const {
  const auto& [a, b, c] = triangle;
  return {triangle, {points_[at(a)], points_[at(b)], points_[at(c)]}};
}

GuardedMesh::Cell GuardedMesh::cell_of(const base::GridPoint& point) const {
  Cell cell;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double fraction = 0.5 + static_cast<double>(point[axis]) / steps_per_extent;
    cell[axis] =
        std::clamp(static_cast<int>(std::floor(fraction * cells_along_)), 0, cells_along_ - 1);
  }
  return cell;
}

template <class Visit>
void GuardedMesh::for_each_cell(const GridBox& box, const Visit& visit) {
  const Cell low = cell_of(box.low), high = cell_of(box.high);
  for (int z = low[2]; z <= high[2]; ++z) {
    for (int y = low[1]; y <= high[1]; ++y) {
      for (int x = low[0]; x <= high[0]; ++x) {
        visit(cells_[(at(z) * at(cells_along_) + at(y)) * at(cells_along_) + at(x)]);
      }
    }
  }
}

void GuardedMesh::enter(std::span<const int> triangles) {
  for (const int t : triangles) {
    for_each_cell(box_of(grid_triangle(mesh_.triangle(t))),
                  [t](std::vector<int>& cell) { cell.push_back(t); });
  }
}

void GuardedMesh::leave(std::span<const int> triangles) {
  for (const int t : triangles) {
    for_each_cell(box_of(grid_triangle(mesh_.triangle(t))),
                  [t](std::vector<int>& cell) { std::erase(cell, t); });
  }
}

/// Those whose boxes overlap the box, each once.
void GuardedMesh::find_near(const GridBox& box, std::span<const int> except) {
  near_.clear();
  ++look_;
  for (const int t : except) last_look_[at(t)] = look_;
  for_each_cell(box, [&](const std::vector<int>& cell) {
    for (const int t : cell) {
      if (std::exchange(last_look_[at(t)], look_) == look_) continue;
      const GridTriangle triangle = grid_triangle(mesh_.triangle(t));
      if (box.overlaps(box_of(triangle))) near_.push_back(triangle);
    }
  });
}

}  // namespace pneuma::assets

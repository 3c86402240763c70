#include "app/picture/faceted.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/base/disjoint_sets.h"

namespace pneuma::app {
namespace {

using sim::Vec3;

/// Of the angle between the normals.
const double cos_flat = std::cos(10.0 / 180.0 * std::numbers::pi);
const double cos_split = std::cos(40.0 / 180.0 * std::numbers::pi);
const double cos_sharp = std::cos(59.9 / 180.0 * std::numbers::pi);
/// Of the length of all edges that are not flat. Parts of machines, with round holes, have 0.3 to
/// 0.7; animals at most 0.13.
constexpr double sharp_share = 0.25;

Vec3 normal(const sim::SoftMesh& mesh, int triangle) {
  const auto& [a, b, c] = mesh.topology.triangles()[sim::at(triangle)];
  const Vec3 corner = mesh.rest_positions[a];
  const Vec3 first = mesh.rest_positions[b] - corner, second = mesh.rest_positions[c] - corner;
  return first.cross(second).stableNormalized();
}

/// Among the corners of all triangles.
int corner_at(const sim::SoftMesh& mesh, int triangle, int vertex) {
  const sim::Triangle& corners = mesh.topology.triangles()[sim::at(triangle)];
  return 3 * triangle + static_cast<int>(std::ranges::find(corners, vertex) - corners.begin());
}

}  // namespace

bool is_faceted(const sim::SoftMesh& mesh) {
  double bent = 0.0, sharp = 0.0;  // m
  for (int edge = 0; edge < mesh.topology.edge_count(); ++edge) {
    const auto& [one, other] = mesh.topology.edge_triangles()[sim::at(edge)];
    const double cosine = normal(mesh, one).dot(normal(mesh, other));
    if (cosine >= cos_flat) continue;
    const auto& [from, to] = mesh.topology.edges()[sim::at(edge)];
    const double length = (mesh.rest_positions[to] - mesh.rest_positions[from]).norm();
    bent += length;
    if (cosine <= cos_sharp) sharp += length;
  }
  return sharp > 0.0 && sharp >= sharp_share * bent;
}

std::vector<std::array<std::uint32_t, 3>> corner_normals(const sim::SoftMesh& mesh) {
  const std::size_t triangles = mesh.topology.triangles().size();
  base::DisjointSets sets(3 * triangles);
  for (int edge = 0; edge < mesh.topology.edge_count(); ++edge) {
    const auto& [one, other] = mesh.topology.edge_triangles()[sim::at(edge)];
    if (normal(mesh, one).dot(normal(mesh, other)) < cos_split) continue;
    for (const int vertex : mesh.topology.edges()[sim::at(edge)]) {
      sets.unite(corner_at(mesh, one, vertex), corner_at(mesh, other, vertex));
    }
  }
  std::vector<std::array<std::uint32_t, 3>> result(triangles);
  for (std::size_t i = 0; i < 3 * triangles; ++i) {
    result[i / 3][i % 3] = static_cast<std::uint32_t>(sets.find(static_cast<int>(i)));
  }
  return result;
}

}  // namespace pneuma::app

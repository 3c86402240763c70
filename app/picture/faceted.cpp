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
/// Of the angle within a face of more than two triangles.
const double cos_within_face = std::cos(2.0 / 180.0 * std::numbers::pi);
/// Of the length of edges of 40 degrees and more: cylinders, however fine, have 1.
constexpr double share_beside_flat = 0.5;

Vec3 normal(const sim::SoftMesh& mesh, int triangle) {
  const auto& [a, b, c] = mesh.topology.triangles()[sim::at(triangle)];
  const Vec3 corner = mesh.rest_positions[a];
  const Vec3 first = mesh.rest_positions[b] - corner, second = mesh.rest_positions[c] - corner;
  return first.cross(second).stableNormalized();
}

/// Of the angle between the normals of its triangles.
double bend_cosine(const sim::SoftMesh& mesh, int edge) {
  const auto& [one, other] = mesh.topology.edge_triangles()[sim::at(edge)];
  return normal(mesh, one).dot(normal(mesh, other));
}

double length(const sim::SoftMesh& mesh, int edge) {
  const auto& [from, to] = mesh.topology.edges()[sim::at(edge)];
  return (mesh.rest_positions[to] - mesh.rest_positions[from]).norm();
}

/// Whether one of its triangles goes on flat beyond both of its other edges.
bool is_beside_flat_face(const sim::SoftMesh& mesh, int edge) {
  return std::ranges::any_of(mesh.topology.edge_triangles()[sim::at(edge)], [&](int triangle) {
    return std::ranges::all_of(mesh.topology.triangle_edges()[sim::at(triangle)], [&](int other) {
      return other == edge || bend_cosine(mesh, other) >= cos_within_face;
    });
  });
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
    const double cosine = bend_cosine(mesh, edge);
    if (cosine >= cos_flat) continue;
    bent += length(mesh, edge);
    if (cosine <= cos_sharp) sharp += length(mesh, edge);
  }
  return sharp > 0.0 && sharp >= sharp_share * bent;
}

bool has_flat_faces(const sim::SoftMesh& mesh) {
  double sharp = 0.0, beside_flat = 0.0;  // m
  for (int edge = 0; edge < mesh.topology.edge_count(); ++edge) {
    if (bend_cosine(mesh, edge) >= cos_split) continue;
    sharp += length(mesh, edge);
    if (is_beside_flat_face(mesh, edge)) beside_flat += length(mesh, edge);
  }
  return sharp > 0.0 && beside_flat >= share_beside_flat * sharp;
}

std::vector<std::array<std::uint32_t, 3>> corner_normals(const sim::SoftMesh& mesh) {
  const std::size_t triangles = mesh.topology.triangles().size();
  base::DisjointSets sets(3 * triangles);
  for (int edge = 0; edge < mesh.topology.edge_count(); ++edge) {
    if (bend_cosine(mesh, edge) < cos_split) continue;
    const auto& [one, other] = mesh.topology.edge_triangles()[sim::at(edge)];
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

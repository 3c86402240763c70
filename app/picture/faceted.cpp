#include "app/picture/faceted.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace pneuma::app {
namespace {

using sim::Vec3;

/// Of the angle between the normals.
const double cos_flat = std::cos(10.0 / 180.0 * std::numbers::pi);
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

}  // namespace pneuma::app

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

Vec3 normal(const sim::SoftMesh& mesh, int triangle) {
  const auto& [a, b, c] = mesh.topology.triangles()[sim::at(triangle)];
  const Vec3 corner = mesh.rest_positions[a];
  const Vec3 first = mesh.rest_positions[b] - corner, second = mesh.rest_positions[c] - corner;
  return first.cross(second).stableNormalized();
}

}  // namespace

bool is_faceted(const sim::SoftMesh& mesh) {
  bool has_sharp_edges = false;
  for (const auto& [one, other] : mesh.topology.edge_triangles()) {
    const double cosine = normal(mesh, one).dot(normal(mesh, other));
    if (cosine < cos_flat && cosine > cos_sharp) return false;
    has_sharp_edges = has_sharp_edges || cosine <= cos_sharp;
  }
  return has_sharp_edges;
}

}  // namespace pneuma::app

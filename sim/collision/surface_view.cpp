#include "sim/collision/surface_view.h"

#include <cmath>

namespace pneuma::sim {

namespace {

/// Twice its area long.
Vec4d normal_of(const SurfaceView& surface, int triangle) {
  const auto& [a, b, c] = surface.topology.triangles()[at(triangle)];
  const VertexReader positions(surface.positions);
  return cross(positions[b] - positions[a], positions[c] - positions[a]);
}

Vec4d unit_or_zero(Vec4d vector) {
  const double length = std::sqrt(dot(vector, vector));
  return length > 0.0 ? vector / length : Vec4d{};
}

}  // namespace

Vec3 feature_normal(const SurfaceView& surface, Feature feature) {
  Vec4d sum{};
  switch (feature.kind) {
    case FeatureKind::vertex:
      for (const int triangle : surface.topology.vertex_triangles(feature.index)) {
        sum += normal_of(surface, triangle);
      }
      break;
    case FeatureKind::edge:
      for (const int triangle : surface.topology.edge_triangles()[at(feature.index)]) {
        sum += unit_or_zero(normal_of(surface, triangle));
      }
      break;
    case FeatureKind::triangle:
      sum = normal_of(surface, feature.index);
      break;
  }
  return to_vec3(unit_or_zero(sum));
}

}  // namespace pneuma::sim

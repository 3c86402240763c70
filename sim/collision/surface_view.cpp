#include "sim/collision/surface_view.h"

#include "sim/mesh/measure.h"

namespace pneuma::sim {

namespace {

Vec3 triangle_area_vector(const SurfaceView& surface, int triangle) {
  const auto [a, b, c] = triangle_corners(surface, triangle);
  return area_vector(a, b, c);
}

Vec3 unit_or_zero(const Vec3& vector) {
  const double length = vector.norm();
  return length > 0.0 ? Vec3(vector / length) : Vec3::Zero();
}

}  // namespace

Segment edge_segment(const SurfaceView& surface, int edge) {
  const auto& [a, b] = surface.topology.edges()[at(edge)];
  return {surface.positions[a], surface.positions[b]};
}

Corners triangle_corners(const SurfaceView& surface, int triangle) {
  const auto& [a, b, c] = surface.topology.triangles()[at(triangle)];
  return {surface.positions[a], surface.positions[b], surface.positions[c]};
}

Vec3 feature_normal(const SurfaceView& surface, Feature feature) {
  Vec3 sum = Vec3::Zero();
  switch (feature.kind) {
    case FeatureKind::vertex:
      for (const int triangle : surface.topology.vertex_triangles(feature.index)) {
        sum += triangle_area_vector(surface, triangle);
      }
      break;
    case FeatureKind::edge:
      for (const int triangle : surface.topology.edge_triangles()[at(feature.index)]) {
        sum += unit_or_zero(triangle_area_vector(surface, triangle));
      }
      break;
    case FeatureKind::triangle:
      sum = triangle_area_vector(surface, feature.index);
      break;
  }
  return unit_or_zero(sum);
}

}  // namespace pneuma::sim

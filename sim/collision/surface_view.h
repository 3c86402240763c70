// A soft body's surface as it lies now, and the features on it.
#pragma once

#include "sim/collision/feature_tests.h"
#include "sim/mesh/topology.h"
#include "sim/mesh/vec4d.h"
#include "sim/mesh/vertex_array.h"

namespace pneuma::sim {

/// Refers to a body's mesh and positions; owns nothing.
struct SurfaceView {
  const MeshTopology& topology;
  const VertexArray& positions;
};

inline Segment edge_segment(const SurfaceView& surface, int edge) {
  const auto& [a, b] = surface.topology.edges()[at(edge)];
  return {surface.positions[a], surface.positions[b]};
}
inline Corners triangle_corners(const SurfaceView& surface, int triangle) {
  const auto& [a, b, c] = surface.topology.triangles()[at(triangle)];
  return {surface.positions[a], surface.positions[b], surface.positions[c]};
}

/// The middle of a feature: the mean of its vertices.
inline Vec4d feature_centre(const SurfaceView& surface, int feature_id) {
  // By FeatureKind, what each corner counts: one formula for all kinds, as in a walk over features
  // they take turns in no order that a processor could foresee.
  constexpr double weights[3][3] = {
      {1.0, 0.0, 0.0}, {0.5, 0.5, 0.0}, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}};
  const auto& [vertices, kind] = surface.topology.feature_corners(feature_id);
  const double* weight = weights[static_cast<std::size_t>(kind)];
  const VertexReader positions(surface.positions);
  return positions[vertices[0]] * weight[0] +
         (positions[vertices[1]] * weight[1] + positions[vertices[2]] * weight[2]);
}

/// Outward unit normal of a feature: a triangle's own, for an edge the average of its two
/// triangles' (ERRATA row 12), for a vertex the average of its triangles' weighted by area
/// (ERRATA row 48). Zero where it does not exist: triangles without area, or that cancel.
Vec3 feature_normal(const SurfaceView& surface, Feature feature);

}  // namespace pneuma::sim

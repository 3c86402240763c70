// A soft body's surface as it lies now, and the features on it.
#pragma once

#include "sim/collision/feature_tests.h"
#include "sim/mesh/topology.h"
#include "sim/mesh/vertex_array.h"

namespace pneuma::sim {

/// Refers to a body's mesh and positions; owns nothing.
struct SurfaceView {
  const MeshTopology& topology;
  const VertexArray& positions;
};

Segment edge_segment(const SurfaceView& surface, int edge);
Corners triangle_corners(const SurfaceView& surface, int triangle);

/// Outward unit normal of a feature: a triangle's own, for an edge the average of its two
/// triangles' (ERRATA row 12), for a vertex the average of its triangles' weighted by area. Zero
/// where it does not exist: triangles without area, or that cancel.
Vec3 feature_normal(const SurfaceView& surface, Feature feature);

}  // namespace pneuma::sim

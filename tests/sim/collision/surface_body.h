// A mesh and where its vertices are, for tests of surfaces without a simulation.
#pragma once

#include "sim/collision/surface_view.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/triangle_mesh.h"

namespace pneuma::sim {

/// A mesh with positions of its own.
struct SurfaceBody {
  MeshTopology topology;
  VertexArray positions;

  explicit SurfaceBody(const TriangleMesh& mesh)
      : topology(static_cast<int>(mesh.vertices.size()), mesh.triangles),
        positions(to_vertex_array(mesh.vertices)) {}

  SurfaceView surface() const { return {topology, positions}; }
  Vec3 point(int vertex) const { return positions[vertex]; }
};

}  // namespace pneuma::sim

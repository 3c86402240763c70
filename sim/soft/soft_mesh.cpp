#include "sim/soft/soft_mesh.h"

#include "sim/mesh/measure.h"

namespace pneuma::sim {

std::shared_ptr<const SoftMesh> make_soft_mesh(const TriangleMesh& mesh) {
  SoftMesh result{MeshTopology(static_cast<int>(mesh.vertices.size()), mesh.triangles),
                  to_vertex_array(mesh.vertices),
                  {},
                  {}};
  const MeshTopology& topology = result.topology;
  for (const auto& [a, b] : topology.edges()) {
    const double length = (result.rest_positions[b] - result.rest_positions[a]).norm();
    if (!(length > 0.0)) {
      throw TopologyError("edge " + std::to_string(a) + "-" + std::to_string(b) + " has no length");
    }
    result.rest_lengths.push_back(length);
  }
  const double mean_springs = 2.0 * topology.edge_count() / topology.vertex_count();
  for (int v = 0; v < topology.vertex_count(); ++v) {
    result.valence_weights.push_back(static_cast<double>(topology.ring(v).size()) / mean_springs);
  }
  return std::make_shared<const SoftMesh>(std::move(result));
}

}  // namespace pneuma::sim

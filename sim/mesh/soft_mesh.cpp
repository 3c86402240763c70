#include "sim/mesh/soft_mesh.h"

#include <cmath>
#include <stdexcept>

#include "sim/mesh/edge_length.h"
#include "sim/mesh/measure.h"

namespace pneuma::sim {

std::shared_ptr<const SoftMesh> make_soft_mesh(const TriangleMesh& mesh) {
  const MeshTopology topology(static_cast<int>(mesh.vertices.size()), mesh.triangles);
  SoftMesh result{topology, ForceTables(topology), to_vertex_array(mesh.vertices), {}, {}};
  for (const auto& [a, b] : topology.edges()) {
    const Vec3 edge = result.rest_positions[b] - result.rest_positions[a];
    if (!(edge.norm() > 0.0)) {
      throw TopologyError("edge " + std::to_string(a) + "-" + std::to_string(b) + " has no length");
    }
    result.rest_lengths.push_back(edge_length(edge));
  }
  const double mean_springs = 2.0 * topology.edge_count() / topology.vertex_count();
  for (int v = 0; v < topology.vertex_count(); ++v) {
    result.valence_weights.push_back(static_cast<double>(topology.ring(v).size()) / mean_springs);
  }
  return std::make_shared<const SoftMesh>(std::move(result));
}

std::shared_ptr<const SoftMesh> make_soft_mesh(const SoftMesh& mesh,
                                               std::vector<double> rest_lengths) {
  if (rest_lengths.size() != mesh.rest_lengths.size()) {
    throw std::invalid_argument(std::to_string(rest_lengths.size()) + " rest lengths for " +
                                std::to_string(mesh.rest_lengths.size()) + " edges");
  }
  for (const double length : rest_lengths) {
    if (std::isfinite(length) && length >= 0.0) continue;
    throw std::invalid_argument("a rest length of " + std::to_string(length) +
                                " m: it must be finite and not negative");
  }
  SoftMesh result = mesh;
  result.rest_lengths = std::move(rest_lengths);
  return std::make_shared<const SoftMesh>(std::move(result));
}

std::shared_ptr<const SoftMesh> with_hinges(const SoftMesh& mesh) {
  SoftMesh result = mesh;
  result.hinges =
      std::make_shared<const HingeTable>(make_hinges(mesh.topology, mesh.rest_positions));
  return std::make_shared<const SoftMesh>(std::move(result));
}

}  // namespace pneuma::sim

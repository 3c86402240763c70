// What soft bodies made from the same source share: topology, rest shape and rest lengths.
#pragma once

#include <memory>
#include <vector>

#include "sim/mesh/force_tables.h"
#include "sim/mesh/hinges.h"
#include "sim/mesh/topology.h"
#include "sim/mesh/triangle_mesh.h"
#include "sim/mesh/vertex_array.h"

namespace pneuma::sim {

/// Immutable. Every unique edge of the mesh is a spring at its rest length (paper 3.1.1,
/// ERRATA row 26).
struct SoftMesh {
  MeshTopology topology;
  ForceTables tables;                   // of the topology
  VertexArray rest_positions;           // m, about the mesh's own origin
  std::vector<double> rest_lengths;     // m, per edge
  std::vector<double> valence_weights;  // springs of a vertex / mean springs (paper 3.1.2)
  std::shared_ptr<const HingeTable> hinges = nullptr;  // of bodies that resist bending
};

/// Throws TopologyError when the mesh is not closed and manifold or has an edge of no length.
std::shared_ptr<const SoftMesh> make_soft_mesh(const TriangleMesh& mesh);

/// The same with other rest lengths, such as find_equilibrium's (sim/equilibrium/equilibrium.h).
/// Throws std::invalid_argument unless there is one per edge, finite and not negative.
std::shared_ptr<const SoftMesh> make_soft_mesh(const SoftMesh& mesh,
                                               std::vector<double> rest_lengths);

/// The same with hinges, which are at rest in its rest positions.
std::shared_ptr<const SoftMesh> with_hinges(const SoftMesh& mesh);

}  // namespace pneuma::sim

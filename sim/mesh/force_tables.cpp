#include "sim/mesh/force_tables.h"

namespace pneuma::sim {

ForceTables::ForceTables(const MeshTopology& topology) {
  for (const auto& [a, b] : topology.edges()) edges.push_back({row_start(a), row_start(b)});
  for (int v = 0; v < topology.vertex_count(); ++v) {
    for (const auto& spoke : topology.ring(v)) {
      spokes.push_back({row_start(spoke.vertex), static_cast<std::uint32_t>(spoke.edge)});
    }
    rings_end.push_back(static_cast<int>(spokes.size()));
  }
}

}  // namespace pneuma::sim

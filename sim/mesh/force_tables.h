// A mesh as the loops over its springs and rings read it. What they wait for is loads: a vertex is
// therefore given by where its row begins, and what they need of it stands together.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/mesh/topology.h"
#include "sim/mesh/vertex_array.h"

namespace pneuma::sim {

struct ForceTables {
  explicit ForceTables(const MeshTopology& topology);

  struct Ends {
    RowStart from, to;
  };
  /// One step around a vertex: the neighbour, and the edge that leads to it.
  struct Spoke {
    RowStart neighbour;
    std::uint32_t edge;
  };

  std::vector<Ends> edges;     // in the order of MeshTopology::edges
  std::vector<Spoke> spokes;   // ring after ring, each in the order of MeshTopology::ring
  std::vector<int> rings_end;  // per vertex, into spokes
};

}  // namespace pneuma::sim

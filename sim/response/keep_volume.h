// Contacts put vertices back by whole depths, which may press a body flat or turn it inside out
// (ERRATA row 33).
#pragma once

#include "sim/mesh/topology.h"
#include "sim/mesh/vertex_array.h"

namespace pneuma::sim {

/// Takes back a part of what has moved the vertices from `before`, where the body has a volume: a
/// half, three quarters, ..., until at least a hundredth of that volume is left. What remains of
/// the overlap is for the next steps.
void keep_volume(const MeshTopology& topology, const VertexArray& before, VertexArray& positions);

}  // namespace pneuma::sim

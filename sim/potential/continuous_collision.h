// How far all vertices may go along straight ways until a pair would come too near.
//
// Conservative advancement (Li, Kaufman and Jiang, Codimensional incremental potential contact,
// 2021, section 5, "additive"): each advance is shorter than a pair would need to use up what is
// certainly free, so that no crossing is missed. `kept` of the distance at the start, or of the
// reach if that is less, is left: the rounding of distances, some 1e-15 of the coordinates, is far
// below it.
#pragma once

#include <optional>
#include <vector>

#include "sim/potential/near_pairs.h"

namespace pneuma::sim {

/// A pair that limits the ways; `pair` is an index, or -1 with the vertex that meets the ground.
struct WayLimit {
  double fraction = 1.0;  // of the ways, 0..1, at which it keeps its distance
  int pair = -1;
  int vertex = -1;
  bool is_limited = false;
};

/// `pairs`: all that may meet on the ways. Pairs of which no vertex moves further than what is free
/// cost one distance each.
WayLimit limit_ways(const ContactSurfaces& surfaces, const std::vector<ContactPair>& pairs,
                    const VertexArray& from, const VertexArray& to, double kept);

}  // namespace pneuma::sim

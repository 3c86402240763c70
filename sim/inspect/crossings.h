// Whether surfaces pass through each other: decided exactly, as they lie at this moment.
#pragma once

#include <vector>

#include "sim/inspect/closed_surface.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// Two bodies whose surfaces pass through each other; first == second: a body that passes through
/// itself. Indices as in closed_surfaces().
struct CrossingPair {
  int first = 0;
  int second = 0;
  int edges = 0;  // that pass through a triangle of the other, of both surfaces together

  friend bool operator==(const CrossingPair&, const CrossingPair&) = default;
};

struct Crossings {
  int between_bodies = 0;  // edges, summed over the pairs
  int within_bodies = 0;
  std::vector<CrossingPair> pairs;  // that cross, ordered by (first, second)
};

/// Edges of one surface that pass through triangles of another body's, and apart from them of the
/// same body's, where edges and triangles with a common vertex do not count. An edge counts once
/// for each body that it passes through, however many of its triangles.
///
/// An edge passes through a surface where it goes from one side of it strictly to the other;
/// surfaces that only touch do not cross, nor does an edge cross what it runs along
/// (base::find_passage, exact for the coordinates as they are). So bodies that lie in each other
/// with faces in common planes may cross nowhere: overlaps() tells. A body whose positions are not
/// all finite crosses nothing.
Crossings crossings(const World& world);
/// The same of any surfaces; those within a surface are looked for in the first `soft` of them.
Crossings crossings(std::vector<ClosedSurface> surfaces, int soft);

/// The first pair of different bodies that cross, none if no such do.
const CrossingPair* first_crossing_bodies(const Crossings& crossings);

}  // namespace pneuma::sim

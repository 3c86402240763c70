// How far bodies lie in each other and in the ground.
#pragma once

#include <functional>
#include <vector>

#include "sim/mesh/triangle_mesh.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// In place of a body's index: the ground.
inline constexpr int ground_body = -1;

/// Two bodies that lie in each other, or one in the ground. Indices as in closed_surfaces().
struct Overlap {
  int first = 0;
  int second = 0;      // or ground_body
  double depth = 0.0;  // m, > 0
};

/// All pairs that overlap at this moment, ordered by (first, second), each body's ground first.
///
/// The depth of a pair is a length by which they must be moved at least to be apart:
///
///   depth = max over points p in both bodies of  d_first(p) + d_second(p),
///
/// d being the distance of p from a body's surface. A ball of radius d_first fits into the first
/// body about p, and one of d_second into the second: whoever moves the bodies apart moves these
/// balls apart, by d_first + d_second. So no motion without rotation that is shorter than the depth
/// parts them; for two half spaces, two balls and a ball in a half space none longer is needed. On
/// the surface of one body the sum is the distance from the surface of the other: the depth is at
/// least that of the deepest vertex, and of the deepest point of an edge. It grows if either body
/// does. Two coincident balls have their diameter, a thin rod through a ball's centre the ball's
/// radius and half its own thickness. Where two edges cross it is the depth of one in the other,
/// down to half of the way apart.
///
/// Of two boxes the shortest way apart is found exactly, and so is the way out of the ground. For
/// the others the greatest sum is searched for, from vertices, points of edges, middles of
/// triangles and a lattice in the common part, uphill: what is found holds as a lower bound, and is
/// less than the maximum by up to a twentieth. A common part that contains none of these points is
/// not seen: crossings() sees every one.
std::vector<Overlap> overlaps(const World& world);
/// The same pairs, found sooner: the search for a pair's depth ends once it is beyond
/// `enough(first, second)`.
std::vector<Overlap> overlaps(const World& world, const std::function<double(int, int)>& enough);

/// The depth of one pair, m, as overlaps() has it; 0 where they do not overlap.
double overlap_depth(const World& world, int first, int second);
/// Whether that is more than `depth`, found sooner.
bool overlap_deeper_than(const World& world, int first, int second, double depth);

}  // namespace pneuma::sim

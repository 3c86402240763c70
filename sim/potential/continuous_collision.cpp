#include "sim/potential/continuous_collision.h"

#include <algorithm>
#include <cmath>

#include "sim/mesh/vec4d.h"
#include "sim/potential/pair_distance.h"

namespace pneuma::sim {
namespace {

/// Of what is certainly free, per advance.
constexpr double advanced = 0.9;
constexpr int max_advances = 200;

/// Whether boxes along the axes about the ways of both features are apart.
bool ways_are_apart(const ContactPair& pair, const VertexReader& from, const VertexReader& to) {
  const auto low = [&](std::size_t i) { return min(from[pair.vertices[i]], to[pair.vertices[i]]); };
  const auto high = [&](std::size_t i) {
    return max(from[pair.vertices[i]], to[pair.vertices[i]]);
  };
  Vec4d first_low = low(0), first_high = high(0), second_low = low(2), second_high = high(2);
  if (pair.is_edges) {
    first_low = min(first_low, low(1));
    first_high = max(first_high, high(1));
  } else {
    second_low = min(second_low, low(1));
    second_high = max(second_high, high(1));
  }
  second_low = min(second_low, low(3));
  second_high = max(second_high, high(3));
  return !all_of_lanes((first_low <= second_high) & (second_low <= first_high));
}

/// How fast a pair comes nearer per fraction of the ways, at most, m. A motion of all four alike
/// changes nothing: their mean is left out.
double max_nearing(const ContactPair& pair, const PairCorners& ways) {
  const Vec3 mean = 0.25 * (ways[0] + ways[1] + ways[2] + ways[3]);
  std::array<double, 4> size;
  for (std::size_t i = 0; i < 4; ++i) size[i] = (ways[i] - mean).norm();
  if (pair.is_edges) return std::max(size[0], size[1]) + std::max(size[2], size[3]);
  return size[0] + std::max({size[1], size[2], size[3]});
}

/// The first fraction at which the pair has come to about `kept` of its distance, or of its reach
/// if it is further apart; 1: never.
double free_fraction(const ContactPair& pair, const VertexArray& from, const VertexArray& to,
                     double kept) {
  PairCorners x, ways;
  for (std::size_t i = 0; i < 4; ++i) {
    x[i] = from[pair.vertices[i]];
    ways[i] = Vec3(to[pair.vertices[i]]) - x[i];
  }
  const double nearing = max_nearing(pair, ways);
  const auto distance_at = [&](double fraction) {
    PairCorners moved;
    for (std::size_t i = 0; i < 4; ++i) moved[i] = x[i] + fraction * ways[i];
    return pair.is_edges ? nearest_edge_edge(moved).distance
                         : nearest_vertex_triangle(moved).distance;
  };
  const double start = distance_at(0.0), least = kept * std::min(start, pair.reach);
  if (start - least > nearing) return 1.0;
  double fraction = 0.0, distance = start;
  for (int i = 0; i < max_advances; ++i) {
    const double next = fraction + advanced * (distance - least) / nearing;
    if (next >= 1.0) return 1.0;
    fraction = next;
    distance = distance_at(fraction);
    if (distance - least < (1.0 - advanced) * (start - least)) break;
  }
  return fraction;
}

}  // namespace

WayLimit limit_ways(const ContactSurfaces& surfaces, const std::vector<ContactPair>& pairs,
                    const VertexArray& from, const VertexArray& to, double kept) {
  WayLimit limit;
  for (int s = 0; surfaces.ground() && s < surfaces.count(); ++s) {
    const ContactSurface& surface = surfaces[s];
    if (!surface.is_mobile) continue;
    for (int v = surface.first_vertex; v < surface.first_vertex + surface.vertex_count; ++v) {
      const double before = from[v].z() + surface.reach, after = to[v].z() + surface.reach;
      const double least = kept * std::min(before, surface.reach);
      if (!surfaces.is_mobile(v) || after >= least) continue;
      const double fraction = (before - least) / (before - after);
      if (fraction < limit.fraction) limit = {std::max(fraction, 0.0), -1, v, true};
    }
  }
  const VertexReader x(from), end(to);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (ways_are_apart(pairs[i], x, end)) continue;
    const double fraction = free_fraction(pairs[i], from, to, kept);
    if (fraction < limit.fraction) limit = {fraction, static_cast<int>(i), -1, true};
  }
  return limit;
}

}  // namespace pneuma::sim

#include "sim/swept/feature_ways.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pneuma::sim {
namespace {

/// Positions of a feature's vertices at one moment, the first again for those it does not have.
Corners corners_of(const MeshTopology& topology, const Feature& feature,
                   const VertexArray& positions) {
  Corners result;
  const auto vertices = topology.feature_vertices(feature);
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = positions[vertices[i < vertices.size() ? i : 0]];
  }
  return result;
}

std::optional<ClosestPoints> closest(const NearFeatures& pair, const Corners& first,
                                     const Corners& second, double reach) {
  if (pair.first.kind == FeatureKind::edge) {
    return closest_edge_edge({first[0], first[1]}, {second[0], second[1]}, reach);
  }
  if (pair.first.kind == FeatureKind::vertex) {
    return closest_vertex_triangle(first[0], second, reach);
  }
  const auto found = closest_vertex_triangle(second[0], first, reach);
  if (!found) return std::nullopt;
  return mirrored(*found);
}

/// Where a pair's corners are at the start of the step, and their ways to its end. The same motion
/// for all changes no distance: their mean is left out.
struct PairMotion {
  Corners first, second;  // m
  Corners first_way, second_way;

  PairMotion(const MovingSurface& a, const MovingSurface& b, const NearFeatures& pair)
      : first(corners_of(a.tree->topology(), pair.first, a.start)),
        second(corners_of(b.tree->topology(), pair.second, b.start)),
        first_way(corners_of(a.tree->topology(), pair.first, a.end)),
        second_way(corners_of(b.tree->topology(), pair.second, b.end)) {
    Vec3 mean = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      first_way[i] -= first[i];
      second_way[i] -= second[i];
      mean += (first_way[i] + second_way[i]) / 6.0;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      first_way[i] -= mean;
      second_way[i] -= mean;
    }
  }

  /// Both from the start to a fraction of the step.
  void advance(Corners& a, Corners& b, double fraction) const {
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] += fraction * first_way[i];
      b[i] += fraction * second_way[i];
    }
  }

  ClosestPoints closest_at(double fraction, const NearFeatures& pair) const {
    Corners a = first, b = second;
    advance(a, b, fraction);
    return *closest(pair, a, b, std::numeric_limits<double>::infinity());
  }

  /// The fraction of the step up to which, after `fraction`, the first lies further than `least`
  /// (m) beyond the second along a direction; 1 or more: to its end.
  double free_until(double fraction, const Vec3& direction, double least) const {
    double soonest = 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const double nearing = direction.dot(second_way[j] - first_way[i]);
        if (nearing <= 0.0) continue;
        const double apart = direction.dot(first[i] - second[j]);
        soonest = std::min(soonest, (apart - least) / nearing);
      }
    }
    return std::max(soonest, fraction);
  }
};

/// The ways of a feature's vertices, the first again for those it does not have.
class FeatureWays {
 public:
  FeatureWays(const MovingSurface& surface, const Feature& feature) {
    const auto vertices = surface.tree->topology().feature_vertices(feature);
    const VertexReader from(surface.start), to(surface.end);
    for (std::size_t i = 0; i < 3; ++i) {
      const int v = vertices[i < vertices.size() ? i : 0];
      ways_[i] = to[v] - from[v];
    }
  }

  Vec4d sum() const { return ways_[0] + ways_[1] + ways_[2]; }
  double greatest_beside(Vec4d mean) const {
    double squared = 0.0;
    for (const Vec4d way : ways_) squared = std::max(squared, dot(way - mean, way - mean));
    return std::sqrt(squared);
  }

 private:
  std::array<Vec4d, 3> ways_;
};

const VertexArray& positions(const MovingSurface& surface, Moment moment) {
  return moment == Moment::start ? surface.start : surface.end;
}

/// Where the vertices of a surface are after a fraction of the step.
class PositionsAt {
 public:
  PositionsAt(const MovingSurface& surface, double fraction)
      : surface_(surface),
        fraction_(fraction),
        as_they_are_(fraction == 0.0   ? &surface.start
                     : fraction == 1.0 ? &surface.end
                                       : nullptr) {}

  Vec3 operator[](int vertex) const {
    if (as_they_are_) return (*as_they_are_)[vertex];
    return (1.0 - fraction_) * surface_.start[vertex] + fraction_ * surface_.end[vertex];
  }

 private:
  const MovingSurface& surface_;
  double fraction_;
  const VertexArray* as_they_are_;  // at the start or the end
};

/// A part of a surface that a point beside the surface may be nearest to, and the way to it.
struct SurfacePart {
  const MovingSurface& surface;
  PositionsAt positions;
  Vec3 point;           // on the part, m
  Vec3 away;            // from there to what is nearest to it, m
  double sine_of_flat;  // of the angle up to which faces are one

  /// Whether going along `inward` brings a point nearer to what this is thought to be nearest to.
  bool is_nearer(const Vec3& inward) const {
    return away.dot(inward) > sine_of_flat * away.norm() * inward.norm();
  }
};

/// Whether no other point next to an edge is nearer: the edge's Voronoi region.
bool is_nearest_edge(const SurfacePart& part, int edge) {
  const MeshTopology& topology = part.surface.tree->topology();
  const PositionsAt& x = part.positions;
  const int from = topology.edges()[at(edge)][0], to = topology.edges()[at(edge)][1];
  const Vec3 along = (x[to] - x[from]).normalized();
  return std::ranges::none_of(topology.edge_triangles()[at(edge)], [&](int triangle) {
    const auto& [a, b, c] = topology.triangles()[at(triangle)];
    const Vec3 opposite = x[a + b + c - from - to];
    const Vec3 inward = opposite - part.point;
    return part.is_nearer(inward - inward.dot(along) * along);
  });
}

bool is_nearest_vertex(const SurfacePart& part, int vertex) {
  return std::ranges::none_of(part.surface.tree->topology().ring(vertex),
                              [&](const MeshTopology::Spoke& spoke) {
                                return part.is_nearer(part.positions[spoke.vertex] - part.point);
                              });
}

/// Whether a pair of a vertex and a `triangle` stands for the part of the triangle that is nearest.
bool stands_for(const SurfacePart& part, int triangle, const FeaturePart& nearest) {
  const SurfaceTree& tree = *part.surface.tree;
  switch (nearest.kind) {
    case FeatureKind::triangle:
      return true;
    case FeatureKind::edge: {
      const int edge = tree.topology().triangle_edges()[at(triangle)][at(nearest.index)];
      return tree.owner_of_edge(edge) == triangle && is_nearest_edge(part, edge);
    }
    case FeatureKind::vertex:
      break;
  }
  const int vertex = tree.topology().triangles()[at(triangle)][at(nearest.index)];
  return tree.owner_of_vertex(vertex) == triangle && is_nearest_vertex(part, vertex);
}

}  // namespace

std::optional<ClosestPoints> closest_points(const MovingSurface& first, const MovingSurface& second,
                                            const NearFeatures& pair, Moment moment, double reach) {
  return closest(pair, corners_of(first.tree->topology(), pair.first, positions(first, moment)),
                 corners_of(second.tree->topology(), pair.second, positions(second, moment)),
                 reach);
}

Vec3 touching_normal(const MovingSurface& first, const MovingSurface& second,
                     const NearFeatures& pair, Moment moment) {
  const Corners a = corners_of(first.tree->topology(), pair.first, positions(first, moment));
  const Corners b = corners_of(second.tree->topology(), pair.second, positions(second, moment));
  const auto across = [](const Corners& t) {
    return (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  };
  if (pair.second.kind == FeatureKind::triangle) return across(b);
  if (pair.first.kind == FeatureKind::triangle) return -across(a);
  const Vec3 normal = (a[1] - a[0]).cross(b[1] - b[0]).normalized();
  const Vec4d towards = (first.nodes.front().low + first.nodes.front().high) -
                        (second.nodes.front().low + second.nodes.front().high);
  return normal.dot(to_vec3(towards)) < 0.0 ? -normal : normal;
}

double greatest_change(const MovingSurface& first, const MovingSurface& second,
                       const NearFeatures& pair) {
  const FeatureWays a(first, pair.first), b(second, pair.second);
  const Vec4d mean = (a.sum() + b.sum()) / 6.0;  // the same motion for all changes no distance
  return a.greatest_beside(mean) + b.greatest_beside(mean);
}

bool are_apart(const MovingSurface& first, const MovingSurface& second, const NearFeatures& pair,
               double distance) {
  constexpr double least_sine_squared = 1e-12;  // below, rounding decides where the plane lies
  const VertexReader a(first.start), b(second.start);
  const auto one = first.tree->topology().feature_vertices(pair.first);
  const auto other = second.tree->topology().feature_vertices(pair.second);
  Vec4d along, aside;
  if (pair.first.kind == FeatureKind::edge) {
    along = a[one[1]] - a[one[0]];
    aside = b[other[1]] - b[other[0]];
  } else if (pair.first.kind == FeatureKind::triangle) {
    along = a[one[1]] - a[one[0]];
    aside = a[one[2]] - a[one[0]];
  } else {
    along = b[other[1]] - b[other[0]];
    aside = b[other[2]] - b[other[0]];
  }
  const Vec4d across = cross(along, aside);
  const double squared = dot(across, across);
  if (!(squared > least_sine_squared * dot(along, along) * dot(aside, aside))) return false;
  const double height = dot(across, a[one[0]] - b[other[0]]);
  return height * height > distance * distance * squared;
}

bool stands_for_its_parts(const MovingSurface& first, const MovingSurface& second,
                          const NearFeatures& pair, const ClosestPoints& closest, double fraction,
                          double sine_of_flat) {
  const Vec3 away = closest.first_point - closest.second_point;
  const auto part = [&](const MovingSurface& surface, const Vec3& point, const Vec3& to_other) {
    return SurfacePart{surface, {surface, fraction}, point, to_other, sine_of_flat};
  };
  const SurfacePart of_first = part(first, closest.first_point, -away);
  const SurfacePart of_second = part(second, closest.second_point, away);
  switch (pair.first.kind) {
    case FeatureKind::edge:
      return closest.first.kind == FeatureKind::edge && closest.second.kind == FeatureKind::edge &&
             is_nearest_edge(of_first, pair.first.index) &&
             is_nearest_edge(of_second, pair.second.index);
    case FeatureKind::vertex:
      return stands_for(of_second, pair.second.index, closest.second);
    case FeatureKind::triangle:
      break;
  }
  // Two vertices that are nearest to each other are one pair, not two.
  if (closest.first.kind == FeatureKind::vertex &&
      is_nearest_vertex(of_second, pair.second.index)) {
    return false;
  }
  return stands_for(of_first, pair.first.index, closest.first);
}

double sine_between_edges(const MovingSurface& first, const MovingSurface& second,
                          const NearFeatures& edges, Moment moment) {
  const auto direction = [moment](const MovingSurface& surface, int edge) -> Vec3 {
    const auto& [from, to] = surface.tree->topology().edges()[at(edge)];
    const VertexArray& x = positions(surface, moment);
    return (x[to] - x[from]).normalized();
  };
  return direction(first, edges.first.index).cross(direction(second, edges.second.index)).norm();
}

bool is_nearest_vertex(const MovingSurface& surface, int vertex, const Vec3& point, double fraction,
                       double sine_of_flat) {
  const PositionsAt positions(surface, fraction);
  const Vec3 from = positions[vertex];
  return is_nearest_vertex({surface, positions, from, point - from, sine_of_flat}, vertex);
}

// Conservative advancement along the line between the nearest points: what slides past is far from
// meeting, however fast.
std::optional<double> time_of_meeting(const MovingSurface& first, const MovingSurface& second,
                                      const NearFeatures& pair, double distance, double least) {
  constexpr double advanced = 0.9;  // of what is certainly free
  constexpr double met = 0.2;       // of the least distance: nearer to it, and they meet
  constexpr int max_advances = 50;  // in practice a few
  if (advanced * (distance - least) >= greatest_change(first, second, pair)) return std::nullopt;
  const PairMotion motion(first, second, pair);
  double fraction = 0.0;
  for (int i = 0; i < max_advances; ++i) {
    const ClosestPoints closest = motion.closest_at(fraction, pair);
    const double free = closest.distance - least;
    if (free < met * least) break;
    const Vec3 apart = (closest.first_point - closest.second_point) / closest.distance;
    fraction = motion.free_until(fraction, apart, least + (1.0 - advanced) * free);
    if (fraction >= 1.0) return std::nullopt;
  }
  return fraction;
}

ClosestPoints closest_points_at(const MovingSurface& first, const MovingSurface& second,
                                const NearFeatures& pair, double fraction) {
  return PairMotion(first, second, pair).closest_at(fraction, pair);
}

}  // namespace pneuma::sim

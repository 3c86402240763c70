#include "sim/swept/moving_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/collision/bounding_sphere.h"

namespace pneuma::sim {
namespace {

constexpr int leaf_triangles = 2;

Vec3 triangle_normal(const VertexArray& positions, const Triangle& t) {
  return area_vector(positions[t[0]], positions[t[1]], positions[t[2]]).normalized();
}

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

ClosestPoints closest(const NearFeatures& pair, const Corners& first, const Corners& second) {
  if (pair.first.kind == FeatureKind::edge) {
    return closest_edge_edge({first[0], first[1]}, {second[0], second[1]});
  }
  if (pair.first.kind == FeatureKind::vertex) return closest_vertex_triangle(first[0], second);
  return mirrored(closest_vertex_triangle(second[0], first));
}

const VertexArray& positions(const MovingSurface& surface, Moment moment) {
  return moment == Moment::start ? surface.start : surface.end;
}

/// A part of a surface that a point beside the surface may be nearest to, and the way to it.
struct SurfacePart {
  const MovingSurface& surface;
  Moment moment;
  Vec3 point;  // on the part, m
  Vec3 away;   // from there to what is nearest to it, m

  /// Whether going along `inward` brings a point nearer to what this is thought to be nearest to.
  bool is_nearer(const Vec3& inward) const {
    constexpr double sine_of_flat = 1e-6;  // surfaces as flat as this are one
    return away.dot(inward) > sine_of_flat * away.norm() * inward.norm();
  }
};

/// Whether no other point next to an edge is nearer: the edge's Voronoi region.
bool is_nearest_edge(const SurfacePart& part, int edge) {
  const MeshTopology& topology = part.surface.tree->topology();
  const VertexArray& x = positions(part.surface, part.moment);
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
  const VertexArray& x = positions(part.surface, part.moment);
  return std::ranges::none_of(part.surface.tree->topology().ring(vertex),
                              [&](const MeshTopology::Spoke& spoke) {
                                return part.is_nearer(x[spoke.vertex] - part.point);
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

/// Goes down two trees together and collects pairs of features.
class PairSearch {
 public:
  PairSearch(const MovingSurface& first, const MovingSurface& second,
             std::vector<NearFeatures>& pairs)
      : first_(first), second_(second), pairs_(pairs) {}

  void descend(int i, int j) {
    if (!overlap(first_.boxes[at(i)], second_.boxes[at(j)])) return;
    const SurfaceTree::Node& a = first_.tree->nodes()[at(i)];
    const SurfaceTree::Node& b = second_.tree->nodes()[at(j)];
    if (a.is_leaf() && b.is_leaf()) return meet_leaves(a, b);
    const bool first_is_larger =
        first_.boxes[at(i)].size().squaredNorm() >= second_.boxes[at(j)].size().squaredNorm();
    if (!a.is_leaf() && (b.is_leaf() || first_is_larger)) {
      descend(i + 1, j);
      descend(first_.tree->nodes()[at(i + 1)].next, j);
    } else {
      descend(i, j + 1);
      descend(i, second_.tree->nodes()[at(j + 1)].next);
    }
  }

 private:
  void meet_leaves(const SurfaceTree::Node& a, const SurfaceTree::Node& b) {
    for (int s = a.first; s < a.end; ++s) {
      for (int t = b.first; t < b.end; ++t) {
        const int one = first_.tree->order()[at(s)], other = second_.tree->order()[at(t)];
        if (overlap(first_.ways[at(one)], second_.ways[at(other)])) meet(one, other);
      }
    }
  }

  void meet(int one, int other) {
    const MeshTopology& a = first_.tree->topology();
    const MeshTopology& b = second_.tree->topology();
    for (const int v : a.triangles()[at(one)]) {
      if (first_.tree->owner_of_vertex(v) != one) continue;
      pairs_.push_back({{FeatureKind::vertex, v}, {FeatureKind::triangle, other}});
    }
    for (const int v : b.triangles()[at(other)]) {
      if (second_.tree->owner_of_vertex(v) != other) continue;
      pairs_.push_back({{FeatureKind::triangle, one}, {FeatureKind::vertex, v}});
    }
    for (const int e : a.triangle_edges()[at(one)]) {
      if (first_.tree->owner_of_edge(e) != one || first_.tree->is_flat(e)) continue;
      for (const int f : b.triangle_edges()[at(other)]) {
        if (second_.tree->owner_of_edge(f) != other || second_.tree->is_flat(f)) continue;
        pairs_.push_back({{FeatureKind::edge, e}, {FeatureKind::edge, f}});
      }
    }
  }

  const MovingSurface& first_;
  const MovingSurface& second_;
  std::vector<NearFeatures>& pairs_;
};

}  // namespace

SurfaceTree::SurfaceTree(const MeshTopology& topology, const VertexArray& rest_positions,
                         bool is_rigid)
    : topology_(topology),
      order_(at(topology.triangle_count())),
      vertex_owner_(at(topology.vertex_count())),
      edge_owner_(at(topology.edge_count())),
      flat_(at(topology.edge_count()), 0) {
  if (is_rigid) find_flat_edges(rest_positions);
  measure_edges(rest_positions);
  for (int t = topology.triangle_count() - 1; t >= 0; --t) {  // the first triangle comes last
    for (const int v : topology.triangles()[at(t)]) vertex_owner_[at(v)] = t;
    for (const int e : topology.triangle_edges()[at(t)]) edge_owner_[at(e)] = t;
  }
  std::vector<Vec3> middles;
  for (const auto& [a, b, c] : topology.triangles()) {
    middles.push_back((rest_positions[a] + rest_positions[b] + rest_positions[c]) / 3.0);
  }
  std::iota(order_.begin(), order_.end(), 0);
  build(middles, 0, topology.triangle_count());
}

void SurfaceTree::find_flat_edges(const VertexArray& rest_positions) {
  // A box's faces are flat to rounding; a millionth of a radian cannot be felt.
  constexpr double cosine_of_flat = 1.0 - 0.5e-12;
  const auto& triangles = topology_.triangles();
  for (int e = 0; e < topology_.edge_count(); ++e) {
    const auto& [s, t] = topology_.edge_triangles()[at(e)];
    const double cosine = triangle_normal(rest_positions, triangles[at(s)])
                              .dot(triangle_normal(rest_positions, triangles[at(t)]));
    flat_[at(e)] = cosine > cosine_of_flat ? 1 : 0;
  }
}

void SurfaceTree::measure_edges(const VertexArray& rest_positions) {
  double sum = 0.0;
  int count = 0;
  for (int e = 0; e < topology_.edge_count(); ++e) {
    if (is_flat(e)) continue;
    const auto& [a, b] = topology_.edges()[at(e)];
    sum += (rest_positions[a] - rest_positions[b]).norm();
    ++count;
  }
  mean_edge_ = sum / std::max(count, 1);
}

void SurfaceTree::build(const std::vector<Vec3>& middles, int first, int end) {
  const std::size_t node = nodes_.size();
  nodes_.emplace_back();
  if (end - first <= leaf_triangles) {
    nodes_[node].first = first;
    nodes_[node].end = end;
  } else {
    Bounds around;
    for (int i = first; i < end; ++i) around.include(middles[at(order_[at(i)])]);
    int axis = 0;
    around.size().maxCoeff(&axis);
    const int half = first + (end - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + end,
                     [&](int a, int b) { return middles[at(a)][axis] < middles[at(b)][axis]; });
    build(middles, first, half);
    build(middles, half, end);
  }
  nodes_[node].next = static_cast<int>(nodes_.size());
}

void refit(MovingSurface& surface, double margin) {
  const SurfaceTree& tree = *surface.tree;
  const auto& triangles = tree.topology().triangles();
  surface.ways.resize(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Bounds& way = surface.ways[t] = Bounds{};
    for (const int v : triangles[t]) {
      way.include(surface.start[v]);
      way.include(surface.end[v]);
    }
    way.low.array() -= margin;
    way.high.array() += margin;
  }
  surface.boxes.resize(tree.nodes().size());
  for (std::size_t i = tree.nodes().size(); i-- > 0;) {
    const SurfaceTree::Node& node = tree.nodes()[i];
    Bounds& box = surface.boxes[i] = Bounds{};
    for (int t = node.first; t < node.end; ++t) box.include(surface.ways[at(tree.order()[at(t)])]);
    if (node.is_leaf()) continue;
    box.include(surface.boxes[i + 1]);
    box.include(surface.boxes[at(tree.nodes()[i + 1].next)]);
  }
}

void find_near_features(const MovingSurface& first, const MovingSurface& second,
                        std::vector<NearFeatures>& pairs) {
  PairSearch(first, second, pairs).descend(0, 0);
}

ClosestPoints closest_points(const MovingSurface& first, const MovingSurface& second,
                             const NearFeatures& pair, Moment moment) {
  const bool start = moment == Moment::start;
  return closest(
      pair, corners_of(first.tree->topology(), pair.first, start ? first.start : first.end),
      corners_of(second.tree->topology(), pair.second, start ? second.start : second.end));
}

bool stands_for_its_parts(const MovingSurface& first, const MovingSurface& second,
                          const NearFeatures& pair, const ClosestPoints& closest, Moment moment) {
  const Vec3 away = closest.first_point - closest.second_point;
  const SurfacePart of_first{first, moment, closest.first_point, -away};
  const SurfacePart of_second{second, moment, closest.second_point, away};
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

bool collide_on_their_ways(const MovingSurface& first, const MovingSurface& second,
                           const NearFeatures& pair, double distance) {
  constexpr double kept = 0.1;       // of the distance at the start
  constexpr double advanced = 0.9;   // of what is certainly free
  constexpr double met = 0.02;       // of the first free way: nearer, and they are taken to meet
  constexpr int max_advances = 200;  // in practice a dozen
  Corners a = corners_of(first.tree->topology(), pair.first, first.start);
  Corners b = corners_of(second.tree->topology(), pair.second, second.start);
  Corners a_way = corners_of(first.tree->topology(), pair.first, first.end);
  Corners b_way = corners_of(second.tree->topology(), pair.second, second.end);
  // The same motion for all changes no distance.
  Vec3 mean = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    a_way[i] -= a[i];
    b_way[i] -= b[i];
    mean += (a_way[i] + b_way[i]) / 6.0;
  }
  double longest_a = 0.0, longest_b = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    a_way[i] -= mean;
    b_way[i] -= mean;
    longest_a = std::max(longest_a, a_way[i].squaredNorm());
    longest_b = std::max(longest_b, b_way[i].squaredNorm());
  }
  const double longest = std::sqrt(longest_a) + std::sqrt(longest_b);
  const double limit = kept * distance;
  double free = distance - limit, moved = 0.0;
  for (int i = 0; i < max_advances; ++i) {
    const double advance = advanced * free;
    if (moved + advance >= longest) return false;
    moved += advance;
    const double t = moved / longest;
    Corners a_now = a, b_now = b;
    for (std::size_t k = 0; k < 3; ++k) {
      a_now[k] += t * a_way[k];
      b_now[k] += t * b_way[k];
    }
    free = closest(pair, a_now, b_now).distance - limit;
    if (free < met * (distance - limit)) return true;
  }
  return true;
}

}  // namespace pneuma::sim

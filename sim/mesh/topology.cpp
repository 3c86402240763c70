#include "sim/mesh/topology.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace pneuma::sim {
namespace {

std::string name(const std::array<int, 2>& edge) {
  return "edge " + std::to_string(edge[0]) + "-" + std::to_string(edge[1]);
}

/// One side of one triangle, from corner `corner` to the next.
struct HalfEdge {
  std::array<int, 2> edge;  // lower vertex first
  bool forward;             // runs from the lower to the higher vertex
  int triangle;
  int corner;
};

std::vector<HalfEdge> half_edges(const std::vector<Triangle>& triangles) {
  std::vector<HalfEdge> result;
  result.reserve(triangles.size() * 3);
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const int a = triangles[at(t)][at(corner)];
      const int b = triangles[at(t)][at((corner + 1) % 3)];
      if (a == b) {
        throw TopologyError("triangle " + std::to_string(t) + " uses vertex " + std::to_string(a) +
                            " twice");
      }
      result.push_back({{std::min(a, b), std::max(a, b)}, a < b, t, corner});
    }
  }
  std::sort(result.begin(), result.end(), [](const HalfEdge& l, const HalfEdge& r) {
    return std::tie(l.edge, r.forward) < std::tie(r.edge, l.forward);
  });
  return result;
}

}  // namespace

MeshTopology::MeshTopology(int vertex_count, std::vector<Triangle> triangles)
    : vertex_count_(vertex_count), triangles_(std::move(triangles)) {
  if (triangles_.empty()) throw TopologyError("the mesh has no triangles");
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (const int v : triangles_[t]) {
      if (v < 0 || v >= vertex_count_) {
        throw TopologyError("triangle " + std::to_string(t) + " uses vertex " + std::to_string(v) +
                            " of a mesh of " + std::to_string(vertex_count_) + " vertices");
      }
    }
  }
  collect_edges();
  order_rings();
  link_features();
  pair_triangles();
}

void MeshTopology::collect_edges() {
  const std::vector<HalfEdge> sides = half_edges(triangles_);
  triangle_edges_.resize(triangles_.size());
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i;
    while (end < sides.size() && sides[end].edge == sides[i].edge) ++end;
    if (end - i == 1)
      throw TopologyError(name(sides[i].edge) + " has one triangle: the mesh is open");
    if (end - i > 2) {
      throw TopologyError(name(sides[i].edge) + " has " + std::to_string(end - i) +
                          " triangles: the mesh is not manifold");
    }
    if (sides[i].forward == sides[i + 1].forward) {
      throw TopologyError(name(sides[i].edge) +
                          " is run through the same way by both its triangles: " +
                          "the mesh is not consistently oriented");
    }
    for (std::size_t side = i; side < end; ++side) {
      triangle_edges_[at(sides[side].triangle)][at(sides[side].corner)] = edge_count();
    }
    edges_.push_back(sides[i].edge);
    edge_triangles_.push_back({sides[i].triangle, sides[i + 1].triangle});
    i = end;
  }
}

void MeshTopology::order_rings() {
  ring_start_.assign(at(vertex_count_) + 1, 0);
  for (const Triangle& triangle : triangles_) {
    for (const int v : triangle) ++ring_start_[at(v) + 1];
  }
  std::partial_sum(ring_start_.begin(), ring_start_.end(), ring_start_.begin());

  // Per vertex and triangle: the side that leaves the vertex and the side that comes back to it.
  struct Wedge {
    int triangle, next, next_edge, previous;
  };
  std::vector<Wedge> wedges(triangles_.size() * 3);
  std::vector<int> filled(ring_start_.begin(), ring_start_.end() - 1);
  for (int t = 0; t < triangle_count(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Triangle& triangle = triangles_[at(t)];
      wedges[at(filled[at(triangle[corner])]++)] = {t, triangle[(corner + 1) % 3],
                                                    triangle_edges_[at(t)][corner],
                                                    triangle[(corner + 2) % 3]};
    }
  }

  ring_.reserve(wedges.size());
  vertex_triangles_.reserve(wedges.size());
  for (int v = 0; v < vertex_count_; ++v) {
    const auto begin = wedges.begin() + ring_start_[at(v)];
    const auto end = wedges.begin() + ring_start_[at(v) + 1];
    if (begin == end)
      throw TopologyError("vertex " + std::to_string(v) + " belongs to no triangle");
    auto wedge = std::min_element(begin, end,
                                  [](const Wedge& l, const Wedge& r) { return l.next < r.next; });
    const int start = wedge->next;
    for (auto count = end - begin; count > 0; --count) {
      ring_.push_back({wedge->next, wedge->next_edge});
      vertex_triangles_.push_back(wedge->triangle);
      const int next = wedge->previous;
      if (next == start && count > 1) {
        throw TopologyError("vertex " + std::to_string(v) +
                            " joins two sheets of the surface: the mesh is not manifold");
      }
      wedge = std::find_if(begin, end, [next](const Wedge& w) { return w.next == next; });
    }
  }
}

void MeshTopology::link_features() {
  feature_start_.push_back(0);
  const auto close = [this] {
    feature_start_.push_back(static_cast<int>(feature_neighbours_.size()));
  };
  const int edge_base = vertex_count();
  const int triangle_base = edge_base + edge_count();
  for (int v = 0; v < vertex_count(); ++v) {
    for (const Spoke& spoke : ring(v)) feature_neighbours_.push_back(edge_base + spoke.edge);
    for (const int t : vertex_triangles(v)) feature_neighbours_.push_back(triangle_base + t);
    close();
  }
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    for (const int v : edges_[e]) feature_neighbours_.push_back(v);
    for (const int t : edge_triangles_[e]) feature_neighbours_.push_back(triangle_base + t);
    close();
  }
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (const int v : triangles_[t]) feature_neighbours_.push_back(v);
    for (const int e : triangle_edges_[t]) feature_neighbours_.push_back(edge_base + e);
    close();
  }
  vertex_indices_.resize(at(vertex_count_));
  std::iota(vertex_indices_.begin(), vertex_indices_.end(), 0);
  for (const int v : vertex_indices_) feature_corners_.push_back({{v, v, v}, FeatureKind::vertex});
  for (const auto& [a, b] : edges_) feature_corners_.push_back({{a, b, a}, FeatureKind::edge});
  for (const Triangle& t : triangles_) feature_corners_.push_back({t, FeatureKind::triangle});
}

/// Each with the first of its neighbours that is not in a pair yet.
void MeshTopology::pair_triangles() {
  std::vector<bool> paired(triangles_.size(), false);
  const auto free_neighbour = [&](int triangle, int edge) {
    const auto& [first, second] = edge_triangles_[at(edge)];
    const int other = first == triangle ? second : first;
    return paired[at(other)] ? -1 : other;
  };
  for (int t = 0; t < triangle_count(); ++t) {
    if (paired[at(t)]) continue;
    paired[at(t)] = true;
    const Triangle& corners = triangles_[at(t)];
    std::array<int, 4> quadrangle{corners[0], corners[1], corners[2], corners[0]};
    for (std::size_t i = 0; i < 3; ++i) {
      const int other = free_neighbour(t, triangle_edges_[at(t)][i]);
      if (other < 0) continue;
      paired[at(other)] = true;
      const int c = corners[i], a = corners[(i + 1) % 3], b = corners[(i + 2) % 3];
      const Triangle& beyond = triangles_[at(other)];
      const int d =
          *std::find_if(beyond.begin(), beyond.end(), [&](int v) { return v != a && v != c; });
      quadrangle = {a, b, c, d};
      break;
    }
    quadrangles_.push_back({row_start(quadrangle[0]), row_start(quadrangle[1]),
                            row_start(quadrangle[2]), row_start(quadrangle[3])});
  }
}

int MeshTopology::feature_id(Feature feature) const {
  switch (feature.kind) {
    case FeatureKind::vertex:
      return feature.index;
    case FeatureKind::edge:
      return vertex_count() + feature.index;
    case FeatureKind::triangle:
      break;
  }
  return vertex_count() + edge_count() + feature.index;
}

}  // namespace pneuma::sim

#include "sim/swept/obstacle_shape.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>

namespace pneuma::sim {
namespace {

/// Normals of a vertex with more neighbours are not looked for: it has some.
constexpr std::size_t max_ring = 32;

Vec4d opposite_corner(const MeshTopology& topology, const VertexReader& x, int edge,
                      std::size_t side) {
  const auto& [from, to] = topology.edges()[at(edge)];
  const auto& [a, b, c] = topology.triangles()[at(topology.edge_triangles()[at(edge)][side])];
  return x[a + b + c - from - to];
}

ObstacleShape::Face face_of(const VertexReader& x, const Triangle& triangle) {
  const Vec4d normal = unit_normal(x, triangle);
  const Vec3x4 corners = corner_columns(x, triangle);
  return {{normal, dot(normal, x[triangle[0]])}, greatest_lane(dots(normal, corners)), corners};
}

bool is_convex(const MeshTopology& topology, const VertexArray& positions, int edge) {
  const VertexReader x(positions);
  const int triangle = topology.edge_triangles()[at(edge)][0];
  const auto& [a, b, c] = topology.triangles()[at(triangle)];
  const Vec4d normal = cross(x[b] - x[a], x[c] - x[a]);
  const Vec4d beyond = opposite_corner(topology, x, edge, 1) - x[topology.edges()[at(edge)][0]];
  const double height = dot(normal, beyond);
  const double least = sine_of_one_face * std::sqrt(dot(normal, normal) * dot(beyond, beyond));
  return !(height >= -least);
}

/// Whether some direction leads away from all neighbours of a vertex. If there are any, one is at
/// right angles to the ways to two neighbours.
bool has_normal(const MeshTopology& topology, const VertexArray& positions, int vertex) {
  const VertexReader x(positions);
  const auto ring = topology.ring(vertex);
  if (ring.size() > max_ring) return true;
  std::array<Vec4d, max_ring> ways;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec4d way = x[ring[i].vertex] - x[vertex];
    ways[i] = way / std::sqrt(dot(way, way));
  }
  const auto all = std::span(ways).first(ring.size());
  const auto leads_away = [&](Vec4d direction) {
    const double least = sine_of_one_face * std::sqrt(dot(direction, direction));
    return std::ranges::none_of(all, [&](Vec4d way) { return dot(direction, way) > least; });
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec4d direction = cross(all[i], all[j]);
      if (leads_away(direction) || leads_away(-direction)) return true;
    }
  }
  return false;
}

}  // namespace

ObstacleShape::EdgeSides edge_sides_of(const MeshTopology& topology, const VertexReader& x,
                                       int edge) {
  const auto& [from, to] = topology.edges()[at(edge)];
  return {x[to] - x[from], opposite_corner(topology, x, edge, 0) - x[from],
          opposite_corner(topology, x, edge, 1) - x[from]};
}

ObstacleShape::ObstacleShape(const MeshTopology& topology, const VertexArray& positions)
    : vertices_(at(topology.vertex_count())), edges_(at(topology.edge_count())) {
  for (int e = 0; e < topology.edge_count(); ++e) {
    edges_[at(e)] = is_convex(topology, positions, e) ? 1 : 0;
  }
  for (int v = 0; v < topology.vertex_count(); ++v) {
    const bool has_edge = std::ranges::any_of(
        topology.ring(v), [&](const auto& spoke) { return edges_[at(spoke.edge)] != 0; });
    vertices_[at(v)] = has_edge && has_normal(topology, positions, v) ? 1 : 0;
  }
}

void ObstacleShape::keep_place(const MovingSurface& surface) {
  const MeshTopology& topology = surface.tree->topology();
  const VertexReader x(surface.start);
  find_planes(surface);
  faces_.clear();
  for (const Triangle& triangle : topology.triangles()) faces_.push_back(face_of(x, triangle));
  edge_sides_.clear();
  for (int e = 0; e < topology.edge_count(); ++e) {
    edge_sides_.push_back(edge_sides_of(topology, x, e));
  }
}

void ObstacleShape::find_planes(const MovingSurface& surface) {
  const SurfaceTree& tree = *surface.tree;
  const auto& triangles = tree.topology().triangles();
  const VertexReader x(surface.start);
  planes_.resize(tree.nodes().size());
  for (std::size_t node = 0; node < planes_.size(); ++node) {
    const auto for_each_triangle = [&](const auto& visit) {
      for (int below = static_cast<int>(node); below < tree.nodes()[node].next; ++below) {
        const SurfaceTree::Node& leaf = tree.nodes()[at(below)];
        for (int t = leaf.first; t < leaf.end; ++t) visit(triangles[at(tree.order()[at(t)])]);
      }
    };
    Vec4d sum{};
    for_each_triangle(
        [&](const Triangle& t) { sum += cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]); });
    const double squared = dot(sum, sum);
    Plane& plane = planes_[node];
    plane.normal = squared > 0.0 ? sum / std::sqrt(squared) : Vec4d{};
    plane.height = -std::numeric_limits<double>::infinity();
    for_each_triangle([&](const Triangle& t) {
      for (const int v : t) plane.height = std::max(plane.height, dot(plane.normal, x[v]));
    });
  }
}

}  // namespace pneuma::sim

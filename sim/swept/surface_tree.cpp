#include "sim/swept/surface_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/mesh/measure.h"

namespace pneuma::sim {
namespace {

constexpr int leaf_triangles = 2;

/// A box's faces are flat to rounding; a millionth of a radian cannot be felt.
constexpr double cosine_of_flat = 1.0 - 0.5e-12;

Vec3 triangle_normal(const VertexArray& positions, const Triangle& t) {
  return area_vector(positions[t[0]], positions[t[1]], positions[t[2]]).normalized();
}

}  // namespace

SurfaceTree::SurfaceTree(const MeshTopology& topology, const VertexArray& rest_positions,
                         bool is_rigid)
    : topology_(topology),
      order_(at(topology.triangle_count())),
      vertex_owner_(at(topology.vertex_count())),
      edge_owner_(at(topology.edge_count())),
      flat_(at(topology.edge_count()), 0) {
  if (is_rigid) {
    find_flat_edges(rest_positions);
    find_face_directions(rest_positions);
  }
  measure_edges(rest_positions);
  for (int t = topology.triangle_count() - 1; t >= 0; --t) {  // the first triangle comes last
    for (const int v : topology.triangles()[at(t)]) vertex_owner_[at(v)] = t;
    for (const int e : topology.triangle_edges()[at(t)]) edge_owner_[at(e)] = t;
  }
  list_owned();
  std::vector<Vec3> middles;
  for (const auto& [a, b, c] : topology.triangles()) {
    middles.push_back((rest_positions[a] + rest_positions[b] + rest_positions[c]) / 3.0);
  }
  std::iota(order_.begin(), order_.end(), 0);
  build(middles, 0, topology.triangle_count());
}

void SurfaceTree::find_flat_edges(const VertexArray& rest_positions) {
  const auto& triangles = topology_.triangles();
  for (int e = 0; e < topology_.edge_count(); ++e) {
    const auto& [s, t] = topology_.edge_triangles()[at(e)];
    const double cosine = triangle_normal(rest_positions, triangles[at(s)])
                              .dot(triangle_normal(rest_positions, triangles[at(t)]));
    flat_[at(e)] = cosine > cosine_of_flat ? 1 : 0;
  }
}

void SurfaceTree::find_face_directions(const VertexArray& rest_positions) {
  const auto& triangles = topology_.triangles();
  const auto normal = [&](int t) { return triangle_normal(rest_positions, triangles[at(t)]); };
  for (int t = 0; t < topology_.triangle_count(); ++t) {
    const bool is_known = std::ranges::any_of(face_directions_, [&](int known) {
      return std::abs(normal(known).dot(normal(t))) > cosine_of_flat;
    });
    if (!is_known) face_directions_.push_back(t);
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

void SurfaceTree::list_owned() {
  for (int t = 0; t < topology_.triangle_count(); ++t) {
    Owned& owned = owned_.emplace_back();
    for (const int v : topology_.triangles()[at(t)]) {
      if (owner_of_vertex(v) == t) owned.vertices_[owned.vertex_count_++] = v;
    }
    for (const int e : topology_.triangle_edges()[at(t)]) {
      if (owner_of_edge(e) == t && !is_flat(e)) owned.edges_[owned.edge_count_++] = e;
    }
  }
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

}  // namespace pneuma::sim

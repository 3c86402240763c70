// Who is next to whom on a triangle mesh: unique edges, ordered rings, and the graph of features
// (vertex, edge, triangle) that collision particles walk over (section 5.2.1).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/mesh/triangle_mesh.h"
#include "sim/mesh/vertex_array.h"

namespace pneuma::sim {

/// Ordered from low to high: collision normals come from the higher of two features (5.3.1).
enum class FeatureKind : std::uint8_t { vertex, edge, triangle };

/// One vertex, edge or triangle of one mesh, by kind and index within the kind.
struct Feature {
  FeatureKind kind = FeatureKind::vertex;
  int index = 0;

  friend bool operator==(const Feature&, const Feature&) = default;
};

/// A mesh that cannot be a soft body: open, non-manifold, or with an index out of range.
class TopologyError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Connectivity of a closed, manifold, consistently oriented mesh. Immutable and shared.
class MeshTopology {
 public:
  /// One step around a vertex: the neighbour, and the edge that leads to it.
  struct Spoke {
    int vertex;
    int edge;
  };

  /// Throws TopologyError naming the first offending vertex or edge.
  MeshTopology(int vertex_count, std::vector<Triangle> triangles);

  int vertex_count() const { return vertex_count_; }
  int edge_count() const { return static_cast<int>(edges_.size()); }
  int triangle_count() const { return static_cast<int>(triangles_.size()); }
  int feature_count() const { return vertex_count() + edge_count() + triangle_count(); }

  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// The two vertices of each edge, lower index first; edges are sorted.
  const std::vector<std::array<int, 2>>& edges() const { return edges_; }
  /// The two triangles at each edge.
  const std::vector<std::array<int, 2>>& edge_triangles() const { return edge_triangles_; }
  /// The three edges of each triangle; edge i joins corners i and i + 1.
  const std::vector<std::array<int, 3>>& triangle_edges() const { return triangle_edges_; }

  /// Every triangle once, nearly all two by two: a, b, c, d stands for the triangles a b c and a c
  /// d, and with d = a for a b c alone. For sums over triangles, which of two that share a side
  /// need little more than of one. Vertices are given by their rows.
  const std::vector<std::array<RowStart, 4>>& quadrangles() const { return quadrangles_; }

  /// The neighbours of a vertex, counter-clockwise seen from outside: spokes i and i + 1 (cyclic)
  /// and the vertex itself make one triangle. Starts at the lowest neighbour.
  std::span<const Spoke> ring(int vertex) const { return slice(ring_, ring_start_, vertex); }

  /// The triangles at a vertex; triangle i lies between spokes i and i + 1 of its ring.
  std::span<const int> vertex_triangles(int vertex) const {
    return slice(vertex_triangles_, ring_start_, vertex);
  }

  /// Features as one range of numbers: vertices, then edges, then triangles.
  int feature_id(Feature feature) const;
  Feature feature(int id) const {
    if (id < vertex_count()) return {FeatureKind::vertex, id};
    id -= vertex_count();
    if (id < edge_count()) return {FeatureKind::edge, id};
    return {FeatureKind::triangle, id - edge_count()};
  }

  /// The features incident to one: of a vertex its edges and triangles, of an edge its two
  /// vertices and two triangles, of a triangle its vertices and edges.
  std::span<const int> feature_neighbours(int id) const {
    return slice(feature_neighbours_, feature_start_, id);
  }

  /// The one, two or three vertices of a feature.
  std::span<const int> feature_vertices(Feature feature) const {
    switch (feature.kind) {
      case FeatureKind::vertex:
        return {&vertex_indices_[at(feature.index)], 1};
      case FeatureKind::edge:
        return edges_[at(feature.index)];
      case FeatureKind::triangle:
        break;
    }
    return triangles_[at(feature.index)];
  }

  /// The same for loops over all kinds of features, which then need not ask which they have.
  struct FeatureCorners {
    std::array<int, 3> vertices;  // the first again instead of those it does not have
    FeatureKind kind;
  };
  const FeatureCorners& feature_corners(int id) const { return feature_corners_[at(id)]; }

 private:
  template <class T>
  static std::span<const T> slice(const std::vector<T>& values, const std::vector<int>& start,
                                  int i) {
    const std::size_t begin = at(start[at(i)]);
    return std::span(values).subspan(begin, at(start[at(i) + 1]) - begin);
  }

  void collect_edges();
  void order_rings();
  void link_features();
  void pair_triangles();

  int vertex_count_ = 0;
  std::vector<Triangle> triangles_;
  std::vector<std::array<int, 2>> edges_;
  std::vector<std::array<int, 2>> edge_triangles_;
  std::vector<std::array<int, 3>> triangle_edges_;
  std::vector<std::array<RowStart, 4>> quadrangles_;
  std::vector<int> ring_start_;
  std::vector<Spoke> ring_;
  std::vector<int> vertex_triangles_;
  std::vector<int> feature_start_;
  std::vector<int> feature_neighbours_;
  std::vector<FeatureCorners> feature_corners_;
  std::vector<int> vertex_indices_;  // 0, 1, 2, ...: what feature_vertices of a vertex points into
};

}  // namespace pneuma::sim

// What of the surface of a soft body or of a box does not change as it moves: its triangles, sorted
// into a bounding hierarchy.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/mesh/topology.h"
#include "sim/mesh/vertex_array.h"

namespace pneuma::sim {

/// Immutable and shared by bodies of one mesh.
///
/// The hierarchy is a binary tree of boxes about triangles, in depth-first order: the first child
/// follows its parent. It is built from the shape at rest and refitted in every step. What judges
/// the contacts has its own (sim/inspect/triangle_tree.h).
///
/// Every vertex and edge belongs to one of its triangles, the first one (Curtis et al. 2008, "Fast
/// collision detection for deformable models using representative-triangles"), so that going
/// through pairs of triangles meets each pair of features once.
class SurfaceTree {
 public:
  struct Node {
    int next = 0;   // the node after all below this one
    int first = 0;  // into order(): the triangles of a leaf; of others an empty range
    int end = 0;

    bool is_leaf() const { return first != end; }
  };
  /// The features that belong to a triangle, in its own order; of edges those that are none to
  /// others left out.
  class Owned {
   public:
    std::span<const int> vertices() const { return std::span(vertices_).first(vertex_count_); }
    std::span<const int> edges() const { return std::span(edges_).first(edge_count_); }

   private:
    friend class SurfaceTree;
    std::array<int, 3> vertices_{}, edges_{};
    std::size_t vertex_count_ = 0, edge_count_ = 0;
  };

  /// Refers to the topology. Of a rigid surface the edges that only divide flat faces, such as the
  /// diagonals of a box, are no edges to others.
  SurfaceTree(const MeshTopology& topology, const VertexArray& rest_positions, bool is_rigid);

  const MeshTopology& topology() const { return topology_; }
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<int>& order() const { return order_; }
  const Owned& owned_by(int triangle) const { return owned_[at(triangle)]; }
  int owner_of_vertex(int vertex) const { return vertex_owner_[at(vertex)]; }
  int owner_of_edge(int edge) const { return edge_owner_[at(edge)]; }
  /// Of eight corners and twelve triangles.
  bool is_box() const { return face_directions_.size() == 3 && order_.size() == 12; }
  bool is_flat(int edge) const { return flat_[at(edge)] != 0; }
  /// Of a rigid surface: a triangle for each direction that its faces have, if only to the other
  /// side. Empty of others.
  const std::vector<int>& face_directions() const { return face_directions_; }
  /// m, the mean length of the edges at rest, flat ones left out.
  double mean_edge() const { return mean_edge_; }

 private:
  void find_flat_edges(const VertexArray& rest_positions);
  void find_face_directions(const VertexArray& rest_positions);
  void measure_edges(const VertexArray& rest_positions);
  void list_owned();
  void build(const std::vector<Vec3>& middles, int first, int end);

  const MeshTopology& topology_;
  std::vector<Node> nodes_;
  std::vector<int> order_;  // triangles, leaf by leaf
  std::vector<int> vertex_owner_;
  std::vector<int> edge_owner_;
  std::vector<Owned> owned_;        // per triangle
  std::vector<std::uint8_t> flat_;  // per edge
  std::vector<int> face_directions_;
  double mean_edge_ = 0.0;
};

}  // namespace pneuma::sim

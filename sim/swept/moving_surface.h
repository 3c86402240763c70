// The surface of a soft body or of a box as it moves through a step, and a bounding hierarchy of
// its triangles: finds the features of two surfaces that may touch on the way.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/mesh/measure.h"
#include "sim/mesh/topology.h"
#include "sim/mesh/vec4d.h"
#include "sim/mesh/vertex_array.h"
#include "sim/swept/closest_points.h"

namespace pneuma::sim {

/// What of a surface does not change as it moves. Immutable and shared by bodies of one mesh.
///
/// The hierarchy is a binary tree of boxes about triangles, in depth-first order: the first child
/// follows its parent. It is built from the shape at rest and refitted in every step.
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

  /// Refers to the topology. Of a rigid surface the edges that only divide flat faces, such as the
  /// diagonals of a box, are no edges to others.
  SurfaceTree(const MeshTopology& topology, const VertexArray& rest_positions, bool is_rigid);

  const MeshTopology& topology() const { return topology_; }
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<int>& order() const { return order_; }
  int owner_of_vertex(int vertex) const { return vertex_owner_[at(vertex)]; }
  int owner_of_edge(int edge) const { return edge_owner_[at(edge)]; }
  bool is_flat(int edge) const { return flat_[at(edge)] != 0; }
  /// m, the mean length of the edges at rest, flat ones left out.
  double mean_edge() const { return mean_edge_; }

 private:
  void find_flat_edges(const VertexArray& rest_positions);
  void measure_edges(const VertexArray& rest_positions);
  void build(const std::vector<Vec3>& middles, int first, int end);

  const MeshTopology& topology_;
  std::vector<Node> nodes_;
  std::vector<int> order_;  // triangles, leaf by leaf
  std::vector<int> vertex_owner_;
  std::vector<int> edge_owner_;
  std::vector<std::uint8_t> flat_;  // per edge
  double mean_edge_ = 0.0;
};

/// The positions of a surface's vertices at the start and at the end of a step, between which they
/// are taken to move along straight lines, and the boxes about these ways.
struct MovingSurface {
  std::shared_ptr<const SurfaceTree> tree;
  VertexArray start;          // m
  VertexArray end;            // m
  std::vector<Bounds> boxes;  // per node of the tree
  std::vector<Bounds> ways;   // per triangle
};

/// Computes the boxes again, each larger by `margin` (m) on all sides.
void refit(MovingSurface& surface, double margin);

/// A feature of each of two surfaces: a vertex and a triangle, a triangle and a vertex, or two
/// edges.
struct NearFeatures {
  Feature first;
  Feature second;

  friend bool operator==(const NearFeatures&, const NearFeatures&) = default;
};

/// Appends every pair of features whose ways may meet, and more, each once, in an order that
/// depends on the surfaces only. Both must have been refitted.
void find_near_features(const MovingSurface& first, const MovingSurface& second,
                        std::vector<NearFeatures>& pairs);

enum class Moment { start, end };

/// The nearest points of a pair at the start or the end of the step.
ClosestPoints closest_points(const MovingSurface& first, const MovingSurface& second,
                             const NearFeatures& pair, Moment moment);

/// Of the pairs of features whose nearest points are on common edges and vertices one stands for
/// them all, and none where other features next to these are nearer.
bool stands_for_its_parts(const MovingSurface& first, const MovingSurface& second,
                          const NearFeatures& pair, const ClosestPoints& closest, Moment moment);

/// Whether the features come nearer to each other on their ways than a tenth of the `distance` (m)
/// that they have at the start; conservative: they may also just come near that. Never misses a
/// crossing: each advance is shorter than the features would need to meet at their greatest
/// relative speed (additive continuous collision detection; Li, Kaufman and Jiang 2021,
/// "Codimensional incremental potential contact", section 5).
bool collide_on_their_ways(const MovingSurface& first, const MovingSurface& second,
                           const NearFeatures& pair, double distance);

}  // namespace pneuma::sim

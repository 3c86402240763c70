// The surface of a soft body or of a box as it moves through a step: finds the features of two
// surfaces that may touch on the way.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "sim/mesh/vec4d.h"
#include "sim/mesh/vertex_array.h"
#include "sim/swept/surface_tree.h"

namespace pneuma::sim {

/// A box along the axes, x y z 0. Empty until something is included.
struct WayBox {
  Vec4d low = Vec4d{} + std::numeric_limits<double>::infinity();
  Vec4d high = Vec4d{} - std::numeric_limits<double>::infinity();

  void include(const WayBox& other) {
    low = min(low, other.low);
    high = max(high, other.high);
  }
};

/// Whether they share a point, if only of their sides.
inline bool overlap(const WayBox& a, const WayBox& b) {
  return all_of_lanes((a.low <= b.high) & (b.low <= a.high));
}

/// About the ways of a surface's vertices and triangles.
struct WayBoxes {
  std::vector<WayBox> vertices;
  std::vector<WayBox> triangles;
  std::vector<WayBox> nodes;  // of the tree
};

/// The positions of a surface's vertices at the start and at the end of a step, between which they
/// are taken to move along straight lines, and the boxes about these ways.
struct MovingSurface : WayBoxes {
  std::shared_ptr<const SurfaceTree> tree;
  VertexArray start;    // m
  VertexArray end;      // m
  double margin = 0.0;  // m, of the boxes
};

/// About the way of an edge.
inline WayBox edge_box(const SurfaceTree& tree, const WayBoxes& boxes, int edge) {
  const auto& [from, to] = tree.topology().edges()[at(edge)];
  WayBox box = boxes.vertices[at(from)];
  box.include(boxes.vertices[at(to)]);
  return box;
}

enum class Moment { start, end };
/// Of the step.
inline double fraction_at(Moment moment) { return moment == Moment::start ? 0.0 : 1.0; }

/// Computes the boxes again, each larger by `margin` (m) on all sides.
void refit(MovingSurface& surface, double margin);
/// The same boxes elsewhere.
void fit(const MovingSurface& surface, double margin, WayBoxes& boxes);

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

/// The same of one surface with itself. Features that share a vertex are no pair.
void find_near_features(const MovingSurface& surface, std::vector<NearFeatures>& pairs);

/// Of two boxes: from the second to the first, across the face that keeps them furthest apart.
Vec3 direction_apart(const MovingSurface& first, const MovingSurface& second, Moment moment);

}  // namespace pneuma::sim

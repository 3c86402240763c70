// A closed triangle mesh whose connectivity can be changed edge by edge.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "sim/mesh/triangle_mesh.h"

namespace pneuma::assets {

using sim::Vec3;

class EditableMesh {
 public:
  explicit EditableMesh(sim::TriangleMesh mesh);

  int vertex_count() const { return static_cast<int>(mesh_.vertices.size()); }
  Vec3& position(int vertex) { return mesh_.vertices[sim::at(vertex)]; }
  const Vec3& position(int vertex) const { return mesh_.vertices[sim::at(vertex)]; }

  /// Indices of the triangles at a vertex, in no order that means anything; none once it is gone.
  const std::vector<int>& triangles_at(int vertex) const { return around_[sim::at(vertex)]; }
  const sim::Triangle& triangle(int index) const { return mesh_.triangles[sim::at(index)]; }
  int valence(int vertex) const { return static_cast<int>(triangles_at(vertex).size()); }

  /// Without doubles, by index.
  std::vector<int> neighbours(int vertex) const;

  /// All edges, lower vertex first, sorted.
  std::vector<std::array<int, 2>> edges() const;

  bool has_edge(int a, int b) const { return !triangles_with(a, b).empty(); }

  /// The two triangles at an edge: the one that runs from a to b first.
  std::array<int, 2> sides(int a, int b) const;
  /// The two vertices opposite an edge: of the triangle that runs from a to b, then of the other.
  std::array<int, 2> opposite(int a, int b) const;

  /// Puts a new vertex on an edge; returns it.
  int split(int a, int b, const Vec3& place);

  /// Whether the surface stays closed and manifold, and no vertex has fewer than four neighbours,
  /// when the edge shrinks to a point.
  bool can_collapse(int a, int b) const;
  /// Shrinks an edge: b is gone and a moves to `place`.
  void collapse(int a, int b, const Vec3& place);

  /// Replaces an edge by that between its two opposite vertices, which must not have one yet.
  void flip(int a, int b);

  /// Without what is gone; the order of what is left stays.
  sim::TriangleMesh compact() const;

 private:
  std::vector<int> triangles_with(int a, int b) const;
  void detach(int triangle);
  void attach(int triangle, const sim::Triangle& corners);

  sim::TriangleMesh mesh_;
  std::vector<std::vector<int>> around_;
};

}  // namespace pneuma::assets

// An obstacle keeps its shape: what of it a soft body can touch first, and planes above its parts,
// are known before the step.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/swept/moving_surface.h"

namespace pneuma::sim {

/// Sine of the angle up to which faces are one: rounding.
inline constexpr double sine_of_one_face = 1e-6;

/// The last of them twice.
inline Vec3x4 corner_columns(const VertexReader& x, const Triangle& triangle) {
  return to_columns(x[triangle[0]], x[triangle[1]], x[triangle[2]], x[triangle[2]]);
}

/// Zero of a triangle without area.
inline Vec4d unit_normal(const VertexReader& x, const Triangle& corners) {
  const Vec4d normal = cross(x[corners[1]] - x[corners[0]], x[corners[2]] - x[corners[0]]);
  const double squared = dot(normal, normal);
  return squared > 0.0 ? normal / std::sqrt(squared) : Vec4d{};
}

/// What of an obstacle does not change.
class ObstacleShape {
 public:
  ObstacleShape(const MeshTopology& topology, const VertexArray& positions);

  /// Whether another surface can touch it first. What is flat, or has something higher on both
  /// sides whichever way one looks, is touched with or after what is beside it.
  bool is_touchable_vertex(int index) const { return vertices_[at(index)] != 0; }
  bool is_touchable_edge(int index) const { return edges_[at(index)] != 0; }

  /// A plane above all triangles below a node of the tree.
  struct Plane {
    Vec4d normal{};       // unit
    double height = 0.0;  // m, along the normal
  };
  /// A triangle in its plane, and a height (m) above which none of its corners is.
  struct Face {
    Plane plane;
    double top = 0.0;
    Vec3x4 corners{};
  };
  /// An edge, and the ways from its first end into both triangles beside it.
  struct EdgeSides {
    Vec4d along{};
    Vec4d into_first{};
    Vec4d into_second{};
  };
  /// Keeps where all is, in the axes in which the obstacle stays there.
  void keep_place(const MovingSurface& surface);
  /// Per node of the tree, per triangle and per edge.
  const std::vector<Plane>& planes() const { return planes_; }
  const std::vector<Face>& faces() const { return faces_; }
  const std::vector<EdgeSides>& edge_sides() const { return edge_sides_; }

 private:
  void find_planes(const MovingSurface& surface);

  std::vector<std::uint8_t> vertices_;
  std::vector<std::uint8_t> edges_;
  std::vector<Plane> planes_;
  std::vector<Face> faces_;
  std::vector<EdgeSides> edge_sides_;
};

ObstacleShape::EdgeSides edge_sides_of(const MeshTopology& topology, const VertexReader& x,
                                       int edge);

}  // namespace pneuma::sim

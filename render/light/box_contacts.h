// The dark between boxes that nearly touch.
//
// The light between bodies is found at the corners of a box's faces (light/indirect.h), most of
// which see more than the cracks next to them. How little these see is found for each pixel from
// signed distances, after Evans ("Fast Approximations for Global Illumination on Dynamic Scenes",
// SIGGRAPH 2006): to a point raised off its face by a reach r, a box at the distance d leaves
// (1 + d / r) / 2 of the light, between 0 and 1. That is none where faces touch, half of it in the
// crease before a wall and below an edge, and all of it of faces side by side.
#pragma once

#include <optional>
#include <vector>

#include "render/geometry/drawn_surface.h"

namespace pneuma::render {

struct OrientedBox {
  Vec3f centre;
  Eigen::Matrix3f axes;  // from world to the box, rows unit
  Vec3f half;            // m, of its sides

  /// m; negative inside.
  float distance_to(const Vec3f& point) const;
  float radius() const { return half.norm(); }
};

/// Of a mesh with sharp edges that is one.
std::optional<OrientedBox> box_of(const Mesh& mesh);

/// Finds the boxes near each face that is turned to the eye.
class BoxContacts {
 public:
  /// Of the frame that the surface was built of: into the light of its lit vertices. Whether any.
  bool find(const std::vector<Mesh>& meshes, const DrawnSurface& surface, const Vec3f& eye,
            std::vector<IndirectLight>& light);

 private:
  struct Body {
    OrientedBox box;
    std::size_t mesh;
    std::vector<std::size_t> near;  // others of the bodies
  };
  struct Near {
    float taken;
    std::size_t body;
  };

  void take_boxes(const std::vector<Mesh>& meshes);
  void find_neighbours();
  bool darken_face(const Body& body, const Vec3f& normal, const LitMesh& lit,
                   const DrawnSurface& surface, std::vector<IndirectLight>& light);

  std::vector<Body> bodies_;
  std::vector<Near> near_;
};

}  // namespace pneuma::render

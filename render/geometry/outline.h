// Where a surface ends as it is seen: the edges between what faces the eye and what does not.
#pragma once

#include <cstdint>
#include <vector>

#include "render/geometry/drawn_surface.h"

namespace pneuma::render {

/// An edge of the drawn surface with what is seen of it on its left.
struct OutlineEdge {
  std::uint32_t from;  // drawn vertices
  std::uint32_t to;
  std::uint32_t triangle;  // on its left
};

/// Outlines, and the creases of flat meshes. Keeps its memory from frame to frame.
class Outline {
 public:
  /// Without edges that reach behind the eye, which have no direction in the picture.
  void find(const DrawnSurface& surface, const View& view);

  const std::vector<OutlineEdge>& edges() const { return edges_; }

 private:
  /// An edge of a triangle that faces the eye, by the places of its ends.
  struct Side {
    std::uint32_t low, high;
    OutlineEdge edge;
  };

  void mark_places(const DrawnSurface& surface, const Vec3f& eye);
  void collect_sides(const DrawnSurface& surface);
  void keep_outlines(const DrawnSurface& surface, const View& view);

  std::vector<char> faces_eye_;  // per triangle
  std::vector<char> seen_;       // per place: bits of what meets there
  std::vector<Side> sides_;
  std::vector<OutlineEdge> edges_;
};

}  // namespace pneuma::render

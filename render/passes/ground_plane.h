// The plane z = 0: its grid, the shadows on it, and what it hides.
#pragma once

#include <vector>

#include "render/passes/ground_shadow.h"

namespace pneuma::render {

/// Nothing is drawn for an eye below the plane.
class GroundPlane {
 public:
  GroundPlane();

  /// Its colour without shadows, over all that is there.
  void draw(const View& view, const Ground& ground);

  /// Darkens what draw() has drawn where light is blocked: where no surface is, if these are
  /// drawn already, with their depths.
  void darken(const View& view, const GroundShadow& shadow, bool surfaces_drawn);

  /// Its depth alone, so that what lies below is not drawn.
  void hide_below(const View& view);

 private:
  void draw_triangles(const std::vector<Eigen::Vector2f>& vertices);

  Vao vao_;
  Buffer vertices_;
  Program colour_;
  GLint colour_view_projection_;
  GLint colour_picture_height_;
  GLint colour_spacing_;
  GLint colour_centre_;
  GLint colour_radius_;
  GLint colour_line_width_;
  Program shadow_;
  GLint shadow_view_projection_;
  GLint shadow_world_to_map_;
  GLint shadow_centre_;
  GLint shadow_radius_;
  Program depth_;
  GLint depth_view_projection_;
};

}  // namespace pneuma::render

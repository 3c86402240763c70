// The plane z = 0 with its grid and the shadows on it.
#pragma once

#include "render/passes/ground_shadow.h"

namespace pneuma::render {

class GroundPlane {
 public:
  GroundPlane();

  /// `map` and `shadow` are null when there are no shadows. Nothing is drawn for an eye below it.
  void draw(const View& view, const Ground& ground, const ShadowMap* map,
            const GroundShadow* shadow);

 private:
  struct Variant {
    explicit Variant(bool shadowed);
    Program program;
    GLint view_projection;
    GLint picture_height;
    GLint spacing;
    GLint centre;
    GLint radius;
    GLint line_width;
    GLint to_light = -1;
    GLint world_to_map = -1;
  };

  void set_up(const Variant& variant, const View& view, const Ground& ground);

  VertexArray vertex_array_;
  Buffer vertices_;
  Variant plain_{false};
  Variant shadowed_{true};
};

}  // namespace pneuma::render

// The bodies: Phong's shading of every pixel, as in the paper's pictures.
#pragma once

#include <vector>

#include "render/passes/shadow_map.h"

namespace pneuma::render {

class Surfaces {
 public:
  Surfaces();

  /// `shadow` is null when there are no shadows.
  void draw(const View& view, const std::vector<DrawnMesh>& meshes, const ShadowMap* shadow);

 private:
  /// One program for each of smooth or flat, with or without shadows, so that none of them pays
  /// for another.
  struct Variant {
    explicit Variant(bool smooth, bool shadowed);
    Program program;
    GLint view_projection;
    GLint eye;
    GLint to_light;
    GLint world_to_map = -1;
    GLint edge = -1;
  };

  void draw_variant(const Variant& variant, bool smooth, const View& view,
                    const std::vector<DrawnMesh>& meshes, const ShadowMap* shadow);

  Variant smooth_lit_{true, false};
  Variant smooth_shadowed_{true, true};
  Variant flat_lit_{false, false};
  Variant flat_shadowed_{false, true};
};

}  // namespace pneuma::render

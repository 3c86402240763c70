// The bodies, lit by the sun, by the sky and by each other.
#pragma once

#include "render/passes/shadow_map.h"
#include "render/passes/surface_buffers.h"

namespace pneuma::render {

class Surfaces {
 public:
  Surfaces();

  /// `shadow` is null when there are no shadows.
  void draw(const View& view, const SurfaceBuffers& surface, const ShadowMap* shadow);

 private:
  /// One program with and one without shadows, so that none pays for the other.
  struct Variant {
    explicit Variant(bool shadowed);
    Program program;
    GLint view_projection;
    GLint eye;
    GLint to_light;
    GLint world_to_map = -1;
    GLint edge = -1;
  };

  Variant lit_{false};
  Variant shadowed_{true};
};

}  // namespace pneuma::render

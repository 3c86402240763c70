// Smooth outlines with one sample a pixel.
//
// A pixel whose middle lies in a triangle is all of its colour, so that outlines are stairs. Over
// them a strip is drawn along each edge where the surface ends, in the edge's own colours, that
// fades to nothing over the next pixel outside: what is covered of a pixel then changes by as much
// as the edge moves. The surface grows by half a pixel. Between two flat faces the strip fades into
// one of them.
#pragma once

#include "render/geometry/outline.h"
#include "render/passes/instanced_quads.h"
#include "render/passes/shadow_map.h"
#include "render/passes/surfaces.h"

namespace pneuma::render {

class Outlines {
 public:
  Outlines();

  /// After the surfaces, with the light of each drawn vertex.
  void draw(const View& view, const DrawnSurface& surface, const std::vector<IndirectLight>& light,
            const ShadowMap* shadow);

 private:
  struct End {
    SurfaceVertex vertex;
    IndirectLight light;
  };
  struct Instance {
    End from;
    End to;
    Vec3f facet;  // the normal of the triangle on the left
  };

  static std::vector<InstanceAttribute> attributes();

  struct Variant {
    explicit Variant(bool shadowed);
    Program program;
    SurfaceUniforms uniforms;
    GLint picture_size;
  };

  Outline outline_;
  std::vector<Instance> instances_;
  InstanceBuffer<Instance> buffer_{attributes()};
  Variant lit_{false};
  Variant shadowed_{true};
};

}  // namespace pneuma::render

// The bodies, lit by the sun, by the sky and by each other.
#pragma once

#include "render/passes/shadow_map.h"
#include "render/passes/surface_buffers.h"

namespace pneuma::render {

/// Where the programs that light surfaces have their uniforms.
struct SurfaceUniforms {
  SurfaceUniforms(const Program& program, bool shadowed);
  /// With the program in use; `shadow` is null for one without.
  void set(const View& view, const ShadowMap* shadow) const;

  GLint view_projection;
  GLint eye;
  GLint to_light;
  GLint world_to_map = -1;
  GLint edge = -1;
  GLint texel = -1;
  // In the map: from a facet's normal to how it leans; the least that its normal is taken to turn
  // to the light; how many texels' widths the light goes through.
  GLint lean_scale = -1;
};

class Surfaces {
 public:
  Surfaces();

  /// `shadow` is null when there are no shadows. `near_boxes`: whether any box nearly touches
  /// another (light/box_contacts.h). `under_lines`: so far behind that the whole width of a line on
  /// the surface is seen.
  void draw(const View& view, const SurfaceBuffers& surface, const ShadowMap* shadow,
            bool near_boxes, bool under_lines);

 private:
  /// A program with and one without shadows, and of both with and without boxes that nearly touch,
  /// so that none pays for the other.
  struct Variant {
    Variant(bool shadowed, bool near_boxes);
    Program program;
    SurfaceUniforms uniforms;
  };

  static void use(const Variant& variant, const View& view, const ShadowMap* shadow);

  struct Variants {
    explicit Variants(bool near_boxes) : lit(false, near_boxes), shadowed(true, near_boxes) {}
    Variant lit;
    Variant shadowed;
  };
  Variants usual_{false};
  Variants of_near_boxes_{true};
};

}  // namespace pneuma::render

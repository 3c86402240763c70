// The shadow on the ground as a small picture in the light's own coordinates.
#pragma once

#include "render/passes/shadow_map.h"

namespace pneuma::render {

/// Everything that casts is above the ground, so a shadow there needs no comparison of depths: the
/// light is blocked wherever it sees anything at all. That cover is reduced to a small picture and
/// blurred twice, narrow and wide; the ground picks between the two by how high the caster is, so
/// that a shadow is crisp where a body touches the ground and softer under what floats. It costs
/// two texture reads a pixel on the ground, instead of a dozen.
class GroundShadow {
 public:
  GroundShadow();

  /// After `map` has been drawn. Leaves its own framebuffer bound.
  void draw(const ShadowMap& map);

  /// Each texture: red the share of light blocked, green that share times how soft the shadow is
  /// to be, 0 for a caster on the ground and 1 for one well above it.
  void bind(GLuint narrow_unit, GLuint wide_unit) const;

 private:
  struct Picture {
    Picture();
    Texture texture;
    Framebuffer framebuffer;
  };

  void blur(const Picture& from, const Picture& to, const Eigen::Vector2f& step);

  VertexArray no_attributes_;
  Sampler sampler_;
  Program cover_;
  GLint cover_texel_;
  GLint cover_ground_;
  GLint cover_softness_;
  Program blur_;
  GLint blur_step_;
  Picture narrow_;
  Picture wide_;
  Picture scratch_;
};

}  // namespace pneuma::render

// The shadow on the ground as a small picture in the light's own coordinates.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/passes/shadow_map.h"

namespace pneuma::render {

/// Everything that casts is above the ground, so a shadow there needs no comparison of depths: the
/// light is blocked wherever it sees anything at all. That cover is reduced to a small picture and
/// blurred twice, narrow and wide; each texel picks between the two by how high the caster is, so
/// that a shadow is crisp where a body touches the ground and softer under what floats. It costs
/// one texture read a pixel on the ground, instead of a dozen.
///
/// The picture is made by the CPU itself, not by shaders: llvmpipe takes 3 ns to read a texel, and
/// five passes over so small a picture would take ten times as long.
class GroundShadow {
 public:
  GroundShadow();

  /// After `map` has been drawn.
  void draw(const ShadowMap& map, const Vec3f& to_light);

  /// The texture: what is left of the ground's colour, in sRGB.
  void bind(GLuint unit) const;

  /// Cells on a side into which the picture is divided, and those that hold any shadow, each by its
  /// column and row.
  static constexpr int cells = 16;
  const std::vector<std::array<int, 2>>& dark_cells() const { return dark_cells_; }

 private:
  using Picture = std::vector<float>;  // one channel, row by row

  void measure_cover(const ShadowMap& map);
  void blur(Picture& picture, float step);
  void upload(const Vec3f& to_light);
  void find_dark_cells();

  std::vector<float> depths_;
  std::vector<float> kernel_;
  Picture cover_;       // fraction of the light that is blocked
  Picture soft_cover_;  // that fraction times how soft the shadow is to be: 0 for a caster on the
                        // ground, 1 for one well above it
  Picture narrow_;
  Picture scratch_;
  std::vector<std::array<std::uint8_t, 4>> bytes_;
  std::vector<std::array<int, 2>> dark_cells_;
  Texture texture_;
  Sampler sampler_;
};

}  // namespace pneuma::render

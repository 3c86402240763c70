// The shadow on the ground as a small picture in the light's own coordinates.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/geometry/drawn_surface.h"
#include "render/light/gather.h"
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
///
/// To it comes, at every fourth texel, what bodies take of the sky (light/gather.h): the soft dark
/// around the place where a body touches the ground. Next to that place, where a body's surface
/// comes near to the ground, it is darker still (light/contact_shade.h).
class GroundShadow {
 public:
  GroundShadow();

  /// Texels on a side; blurred, so that more would not show. The shadow map lies within a margin:
  /// the ground is darkened beside a body, too.
  static constexpr int size = 192;
  static constexpr int margin = 24;
  static constexpr int inner = size - 2 * margin;

  /// After `map` has been drawn and its depths read.
  void draw(const ShadowMap& map, const ShadowDepths& depths, const Vec3f& to_light,
            const BodyTree& bodies, const DrawnSurface& surface);

  /// The texture: what is left of the ground's colour, in sRGB.
  void bind(GLuint unit) const;
  const Mat4f& world_to_picture() const { return world_to_picture_; }
  /// Where the light that passes a point of the picture meets the ground.
  Eigen::Vector2f on_ground(float u, float v) const;

  /// How much of its light the ground has left that a surface sees: on average over a place before
  /// it that is the wider the higher the surface is.
  float left_below(const Vec3f& position, const Vec3f& normal) const;

  /// What a crowd takes of the sky reaches further than the picture: beyond its border the darkness
  /// there goes on and falls to none over half the picture's width, as what a ball takes does with
  /// its distance. `at` is in the picture's coordinates.
  static constexpr float fading = 0.5f;
  static float fraction_beyond(const Eigen::Vector2f& at);

  /// Cells on a side into which the picture is divided, and those that hold any shadow, each by its
  /// column and row. Where its border is dark, cells beyond it are among them.
  static constexpr int cells = 16;
  const std::vector<std::array<int, 2>>& dark_cells() const { return dark_cells_; }

 private:
  using Picture = std::vector<float>;  // one channel, row by row

  void measure_cover(const ShadowMap& map, const ShadowDepths& depths);
  /// `side`: texels on a side of the picture.
  void blur(Picture& picture, float step, int side);
  void measure_ambient(const BodyTree& bodies);
  void measure_contact(const DrawnSurface& surface);
  void add_up();
  void average_down();
  float left_at_level(std::size_t level, const Eigen::Vector2f& at) const;
  void upload();
  void find_dark_cells();
  bool is_dark(int column, int row) const;

  Mat4f picture_to_map_;
  Mat4f map_to_world_;
  Mat4f world_to_picture_;
  Vec3f to_light_;
  float texel_ = 1.0f;  // m
  std::vector<float> kernel_;
  Picture cover_;       // fraction of the light that is blocked
  Picture soft_cover_;  // that fraction times how soft the shadow is to be: 0 for a caster on the
                        // ground, 1 for one well above it
  Picture narrow_;
  Picture scratch_;
  Picture contact_;  // how near surfaces come to the ground, 0..1; for two by two texels each
  // What comes of sky and bodies, as a fraction of the open ground's light; at some of the texels.
  std::vector<Eigen::Array4f> ambient_;
  std::vector<Picture> left_;  // of the ground's light; each half as many texels a side
  std::array<std::uint8_t, 1024> tone_;
  Receivers receivers_;
  std::vector<std::array<std::uint8_t, 4>> bytes_;
  std::vector<std::array<int, 2>> dark_cells_;
  Texture texture_;
  Sampler sampler_;
};

}  // namespace pneuma::render

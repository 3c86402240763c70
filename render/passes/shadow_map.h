// What the light sees: depth along the light.
#pragma once

#include "render/frame/view.h"
#include "render/passes/program.h"
#include "render/passes/surface_buffers.h"

namespace pneuma::render {

/// A shadow map in the CPU's memory.
struct ShadowDepths {
  int size = 0;               // texels on a side
  std::vector<float> depths;  // row by row; 1 where there is nothing
  Mat4f world_to_map;

  const float* row(int y) const { return depths.data() + static_cast<std::ptrdiff_t>(y) * size; }
  /// Whether the light reaches a point.
  bool lit(const Vec3f& point) const;
};

/// Depth of the meshes' far sides as the light sees them. Storing far sides rather than near ones
/// leaves the whole thickness of a body between a lit surface and the stored depth, so that there
/// is no acne, nor a bias that would lift a shadow off its body by more than a texel or so: edges
/// and bodies without gas have no thickness.
class ShadowMap {
 public:
  explicit ShadowMap(int size);

  void draw(const View& view, const Light& light, const SurfaceBuffers& surface);

  /// From world to the map's texture coordinates and depth, all 0..1.
  const Mat4f& world_to_map() const { return world_to_map_; }
  /// Half the width of a shadow's edge, in texture coordinates.
  float edge() const { return edge_; }
  float texel() const { return 1.0f / static_cast<float>(size_); }
  /// Texels on a side.
  int size() const { return size_; }
  /// Metres from depth 0 to depth 1.
  float depth_range() const { return depth_range_; }
  /// Metres from coordinate 0 to coordinate 1.
  float extent() const { return extent_; }

  /// The map for sampler2DShadow: fraction of lit texels.
  void bind(GLuint unit) const;
  /// Waits until it is drawn.
  void read(ShadowDepths& depths) const;

 private:
  void fit(const View& view, const Light& light);

  int size_;
  Program program_;
  GLint world_to_clip_;
  Texture depth_;
  Sampler sampler_;
  Framebuffer framebuffer_;
  Mat4f world_to_map_ = Mat4f::Identity();
  float edge_ = 0.0f;
  float depth_range_ = 1.0f;
  float extent_ = 1.0f;
};

}  // namespace pneuma::render

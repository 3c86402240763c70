// The picture without bodies: background and ground.
#pragma once

#include <optional>
#include <vector>

#include "render/passes/background.h"
#include "render/passes/ground_plane.h"

namespace pneuma::render {

/// Drawn once and kept for as long as nothing changes in it, which in most runs is always.
class Scenery {
 public:
  Scenery(int width, int height);

  /// Fills the framebuffer that is bound.
  void draw(const View& view, const std::optional<Ground>& ground, GroundPlane& ground_plane);

 private:
  /// All that the picture depends on, but its size.
  struct Key {
    Mat4f view_projection;
    Vec3f eye;
    Vec3f target;
    float ground_radius;
    std::optional<float> grid_spacing;
    bool operator==(const Key&) const = default;
  };

  int width_;
  int height_;
  std::optional<Key> drawn_;
  Background background_;
  Renderbuffer colour_;
  Framebuffer framebuffer_;
};

}  // namespace pneuma::render

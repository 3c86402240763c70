// Where a camera stands and what it sees, as matrices. Pure functions, no GL.
#pragma once

#include <Eigen/Core>

#include "render/frame/frame.h"

namespace pneuma::render {

using Mat4f = Eigen::Matrix4f;

/// A box along the axes. Empty (nothing inside) until grown.
struct Box {
  Vec3f min = Vec3f::Constant(std::numeric_limits<float>::infinity());
  Vec3f max = Vec3f::Constant(-std::numeric_limits<float>::infinity());

  bool empty() const { return !(min.array() <= max.array()).all(); }
  void grow(const Vec3f& point);
  Vec3f centre() const { return 0.5f * (min + max); }
  /// Bit 0, 1, 2 of `index` (0..7) picks max instead of min in x, y, z.
  Vec3f corner(int index) const;
};

/// From world to view space: x to the right, y up, z towards the viewer. +z of the world is up in
/// the picture; looking straight up or down, +y is. Eye and target must differ.
Mat4f view_matrix(const Camera& camera);

/// From view space to clip space as GL has it. `field_of_view` is vertical, in degrees; `aspect` is
/// width / height; 0 < near < far, in metres before the eye.
Mat4f projection_matrix(float field_of_view, float aspect, float near, float far);

struct ViewDirection {
  float azimuth = 0.0f;     // degrees; 0 stands at -y and looks along +y, 90 stands at +x
  float elevation = 25.0f;  // degrees above the horizon, -90..90
};

/// The nearest camera in that direction that has the whole box in view, centred, with `margin` of
/// the picture's half width and half height left free on each side (0 <= margin < 1). A box smaller
/// than a millimetre is seen as one of a millimetre. Throws std::invalid_argument when the box is
/// empty or not finite, or another argument is out of its range.
Camera look_at_bounds(const Box& box, const ViewDirection& direction, float field_of_view,
                      float aspect, float margin = 0.1f);

}  // namespace pneuma::render

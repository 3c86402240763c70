// Where a camera stands and what it sees, as matrices. Pure functions, no GL.
#pragma once

#include <Eigen/Core>
#include <array>

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

/// Parts of the picture's half width and half height that stay free, each 0 or more and below 1.
struct Margins {
  float side = 0.1f;
  float top = 0.1f;
  float bottom = 0.1f;
};

/// Finds the nearest camera in a direction that has all points in view.
class ViewFit {
 public:
  /// `origin`: near the points, for the digits' sake. Throws std::invalid_argument when an argument
  /// is out of its range.
  ViewFit(const ViewDirection& direction, float field_of_view, float aspect, const Margins& margins,
          const Vec3f& origin);

  void add(const Vec3f& point);
  /// All points of a level circle: a point that is turned about the vertical through `centre`.
  void add_circle(const Vec3f& centre, float radius);

  /// What the fit knows of its points: how far they reach towards each side, m. Only ever grows.
  using Seen = std::array<float, 6>;
  Seen seen() const;
  /// Adds the points of another fit with the same arguments.
  void include(const Seen& seen);

  /// Of all points so far, at least one. Its target is level with the middle of their depths, and
  /// no nearer than a millimetre.
  Camera camera() const;

 private:
  /// The eye's offset along one axis from which all points are in view, as a function of how far
  /// forward the eye is: a point at (u, depth) is in view when
  /// -low (depth - eye_depth) <= u - eye_u <= high (depth - eye_depth).
  struct Span {
    float low;  // slopes of the view's sides
    float high;
    float right = -std::numeric_limits<float>::infinity();
    float left = -std::numeric_limits<float>::infinity();

    void add(float u, float depth);
    float furthest_forward() const { return -(right + left) / (low + high); }
    float centre(float forward) const {
      return 0.5f * (right + high * forward - left - low * forward);
    }
  };

  Vec3f origin_;
  Vec3f backward_;
  Eigen::Matrix3f axes_;
  float field_of_view_;
  Span across_;
  Span upright_;
  std::array<Vec3f, 6> outermost_;  // directions to the points of a circle that decide
  float nearest_ = std::numeric_limits<float>::infinity();  // depth of the points, m
  float furthest_ = -std::numeric_limits<float>::infinity();
};

/// The nearest camera in that direction that has the whole box in view, centred, with `margin` of
/// the picture's half width and half height left free on each side (0 <= margin < 1). A box smaller
/// than a millimetre is seen as one of a millimetre. Throws std::invalid_argument when the box is
/// empty or not finite, or another argument is out of its range.
Camera look_at_bounds(const Box& box, const ViewDirection& direction, float field_of_view,
                      float aspect, float margin = 0.1f);

}  // namespace pneuma::render

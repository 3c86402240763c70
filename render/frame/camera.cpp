#include "render/frame/camera.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace pneuma::render {
namespace {

constexpr float radians = std::numbers::pi_v<float> / 180.0f;

/// The rows of the view matrix: right, up, backward.
Eigen::Matrix3f view_axes(const Vec3f& backward) {
  const Vec3f z = backward.normalized();
  // Within 0.06 degrees of the vertical the world's up direction says nothing about the picture's.
  const Vec3f up = std::abs(z.z()) > 0.9999995f ? Vec3f::UnitY() : Vec3f::UnitZ();
  const Vec3f x = up.cross(z).normalized();
  Eigen::Matrix3f axes;
  axes << x.transpose(), z.cross(x).transpose(), z.transpose();
  return axes;
}

void require(bool fine, const std::string& message) {
  if (!fine) throw std::invalid_argument("look_at_bounds: " + message);
}

/// The span of the eye's offset along one axis from which all points are in view, as a function of
/// how far forward the eye is: a point at (u, depth) is in view when |u - eye_u| <= slope (depth -
/// eye_depth), that is when  eye_u - slope eye_depth >= right  and  -eye_u - slope eye_depth >=
/// left.
struct Span {
  float slope;
  float right = -std::numeric_limits<float>::infinity();
  float left = -std::numeric_limits<float>::infinity();

  void add(float u, float depth) {
    right = std::max(right, u - slope * depth);
    left = std::max(left, -u - slope * depth);
  }
  float furthest_forward() const { return -(right + left) / (2.0f * slope); }
  float centre() const { return 0.5f * (right - left); }
};

}  // namespace

void Box::grow(const Vec3f& point) {
  min = min.cwiseMin(point);
  max = max.cwiseMax(point);
}

Vec3f Box::corner(int index) const {
  return {(index & 1) != 0 ? max.x() : min.x(), (index & 2) != 0 ? max.y() : min.y(),
          (index & 4) != 0 ? max.z() : min.z()};
}

Mat4f view_matrix(const Camera& camera) {
  const Eigen::Matrix3f axes = view_axes(camera.eye - camera.target);
  Mat4f view = Mat4f::Identity();
  view.topLeftCorner<3, 3>() = axes;
  view.topRightCorner<3, 1>() = -axes * camera.eye;
  return view;
}

Mat4f projection_matrix(float field_of_view, float aspect, float near, float far) {
  const float slope = std::tan(0.5f * field_of_view * radians);
  Mat4f projection = Mat4f::Zero();
  projection(0, 0) = 1.0f / (slope * aspect);
  projection(1, 1) = 1.0f / slope;
  projection(2, 2) = -(far + near) / (far - near);
  projection(2, 3) = -2.0f * far * near / (far - near);
  projection(3, 2) = -1.0f;
  return projection;
}

Camera look_at_bounds(const Box& box, const ViewDirection& direction, float field_of_view,
                      float aspect, float margin) {
  require(!box.empty() && box.min.allFinite() && box.max.allFinite(),
          "the box must be finite, with min <= max");
  require(std::isfinite(direction.azimuth), "the azimuth must be finite");
  require(std::abs(direction.elevation) <= 90.0f,
          fmt::format("the elevation is {}; allowed is -90..90 degrees", direction.elevation));
  require(field_of_view >= 1.0f && field_of_view <= 120.0f,
          fmt::format("the field of view is {}; allowed is 1..120 degrees", field_of_view));
  require(aspect > 0.0f && std::isfinite(aspect), "the aspect must be positive");
  require(margin >= 0.0f && margin < 1.0f,
          fmt::format("the margin is {}; allowed is 0 or more and below 1", margin));

  const float azimuth = direction.azimuth * radians;
  const float elevation = direction.elevation * radians;
  const Vec3f backward = {std::sin(azimuth) * std::cos(elevation),
                          -std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
  const Eigen::Matrix3f axes = view_axes(backward);
  const Vec3f centre = box.centre();
  const Vec3f half = (0.5f * (box.max - box.min)).cwiseMax(0.0005f);

  const float slope = (1.0f - margin) * std::tan(0.5f * field_of_view * radians);
  Span across{slope * aspect};
  Span upright{slope};
  float nearest = std::numeric_limits<float>::infinity();
  for (int i = 0; i < 8; ++i) {
    const Vec3f corner = axes * Box{-half, half}.corner(i);
    across.add(corner.x(), -corner.z());
    upright.add(corner.y(), -corner.z());
    nearest = std::min(nearest, -corner.z());
  }
  const float forward = std::min(across.furthest_forward(), upright.furthest_forward());
  const Vec3f eye = axes.transpose() * Vec3f(across.centre(), upright.centre(), -forward);

  Camera camera;
  camera.eye = centre + eye;
  // The target is level with the box's centre, so that it also says how far away the scene is.
  camera.target = camera.eye + backward * forward;
  camera.field_of_view = field_of_view;
  return camera;
}

}  // namespace pneuma::render

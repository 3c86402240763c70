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

void ViewFit::Span::add(float u, float depth) {
  right = std::max(right, u - high * depth);
  left = std::max(left, -u - low * depth);
}

ViewFit::ViewFit(const ViewDirection& direction, float field_of_view, float aspect,
                 const Margins& margins, const Vec3f& origin)
    : origin_(origin), field_of_view_(field_of_view) {
  require(std::isfinite(direction.azimuth), "the azimuth must be finite");
  require(std::abs(direction.elevation) <= 90.0f,
          fmt::format("the elevation is {}; allowed is -90..90 degrees", direction.elevation));
  require(field_of_view >= 1.0f && field_of_view <= 120.0f,
          fmt::format("the field of view is {}; allowed is 1..120 degrees", field_of_view));
  require(aspect > 0.0f && std::isfinite(aspect), "the aspect must be positive");
  for (const float margin : {margins.side, margins.top, margins.bottom}) {
    require(margin >= 0.0f && margin < 1.0f,
            fmt::format("the margin is {}; allowed is 0 or more and below 1", margin));
  }
  const float azimuth = direction.azimuth * radians;
  const float elevation = direction.elevation * radians;
  backward_ = {std::sin(azimuth) * std::cos(elevation), -std::cos(azimuth) * std::cos(elevation),
               std::sin(elevation)};
  axes_ = view_axes(backward_);
  const float slope = std::tan(0.5f * field_of_view * radians);
  const float side = (1.0f - margins.side) * slope * aspect;
  across_ = {side, side};
  upright_ = {(1.0f - margins.bottom) * slope, (1.0f - margins.top) * slope};
  const Eigen::RowVector3f depth = -axes_.row(2);
  const Eigen::RowVector3f planes[] = {axes_.row(0) - across_.high * depth,
                                       -axes_.row(0) - across_.low * depth,
                                       axes_.row(1) - upright_.high * depth,
                                       -axes_.row(1) - upright_.low * depth,
                                       depth,
                                       -depth};
  for (std::size_t i = 0; i < outermost_.size(); ++i) {
    const Vec3f level(planes[i].x(), planes[i].y(), 0.0f);
    outermost_[i] = level.normalized();  // of zero, where all points of a circle are alike: zero
  }
}

void ViewFit::add(const Vec3f& point) {
  const Vec3f seen = axes_ * (point - origin_);
  const float depth = -seen.z();
  across_.add(seen.x(), depth);
  upright_.add(seen.y(), depth);
  nearest_ = std::min(nearest_, depth);
  furthest_ = std::max(furthest_, depth);
}

void ViewFit::add_circle(const Vec3f& centre, float radius) {
  for (const Vec3f& direction : outermost_) add(centre + radius * direction);
}

ViewFit::Seen ViewFit::seen() const {
  return {across_.right, across_.left, upright_.right, upright_.left, -nearest_, furthest_};
}

void ViewFit::include(const Seen& seen) {
  across_.right = std::max(across_.right, seen[0]);
  across_.left = std::max(across_.left, seen[1]);
  upright_.right = std::max(upright_.right, seen[2]);
  upright_.left = std::max(upright_.left, seen[3]);
  nearest_ = std::min(nearest_, -seen[4]);
  furthest_ = std::max(furthest_, seen[5]);
}

Camera ViewFit::camera() const {
  const float forward = std::min(across_.furthest_forward(), upright_.furthest_forward());
  const Vec3f eye =
      axes_.transpose() * Vec3f(across_.centre(forward), upright_.centre(forward), -forward);
  Camera camera;
  camera.eye = origin_ + eye;
  const float distance = std::max(0.5f * (nearest_ + furthest_) - forward, 0.001f);
  camera.target = camera.eye - distance * backward_;
  camera.field_of_view = field_of_view_;
  return camera;
}

Camera look_at_bounds(const Box& box, const ViewDirection& direction, float field_of_view,
                      float aspect, float margin) {
  require(!box.empty() && box.min.allFinite() && box.max.allFinite(),
          "the box must be finite, with min <= max");
  const Vec3f half = (0.5f * (box.max - box.min)).cwiseMax(0.0005f);
  ViewFit fit(direction, field_of_view, aspect, {margin, margin, margin}, box.centre());
  const Box seen = {box.centre() - half, box.centre() + half};
  for (int i = 0; i < 8; ++i) fit.add(seen.corner(i));
  return fit.camera();
}

}  // namespace pneuma::render

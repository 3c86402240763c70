#include "render/frame/view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace pneuma::render {
namespace {

/// The min. and max. distance before the eye of the box's corners.
struct DepthRange {
  float near = std::numeric_limits<float>::infinity();
  float far = 0.0f;

  void add(float depth) {
    near = std::min(near, depth);
    far = std::max(far, depth);
  }
};

/// Grows around what is seen of points; knows when that could be anywhere.
class SeenBox {
 public:
  explicit SeenBox(const View& view) : view_(view) {}

  void add(const Vec3f& point) {
    const Eigen::Vector4f clip = view_.view_projection * point.homogeneous();
    everywhere_ = everywhere_ || clip.w() <= view_.near;  // it, or a triangle of it, is cut
    const Eigen::Vector2f at = (0.5f * clip.head<2>() / clip.w()).array() + 0.5f;
    min_ = min_.cwiseMin(at);
    max_ = max_.cwiseMax(at);
  }

  Region pixels() const {
    const Region whole = {0, 0, view_.width, view_.height};
    if (everywhere_) return whole;
    const auto span = [](float from, float to, int count, int& begin, int& length) {
      const auto most = static_cast<float>(count);
      begin = static_cast<int>(std::clamp(std::floor(from * most) - 1.0f, 0.0f, most));
      length = static_cast<int>(std::clamp(std::ceil(to * most) + 1.0f, 0.0f, most)) - begin;
    };
    Region region;
    span(min_.x(), max_.x(), view_.width, region.x, region.width);
    span(min_.y(), max_.y(), view_.height, region.y, region.height);
    return region.width > 0 && region.height > 0 ? region : Region{};
  }

 private:
  const View& view_;
  bool everywhere_ = false;
  Eigen::Vector2f min_ = Eigen::Vector2f::Constant(std::numeric_limits<float>::infinity());
  Eigen::Vector2f max_ = -min_;
};

}  // namespace

float depth(const View& view, const Vec3f& position) {
  return -view.view.row(2).dot(position.homogeneous());
}

Eigen::Vector2f picture_size(const View& view) {
  return {static_cast<float>(view.width), static_cast<float>(view.height)};
}

View make_view(const Frame& frame, int width, int height) {
  View view;
  view.view = view_matrix(frame.camera);
  view.eye = frame.camera.eye;
  view.target = frame.camera.target;
  view.to_light = -frame.light.direction.normalized();
  view.width = width;
  view.height = height;
  view.pixel_scale = static_cast<float>(height) / 480.0f;
  for (const Mesh& mesh : frame.meshes) {
    for (const Vec3f& position : mesh.positions) view.casters.grow(position);
  }

  Box all = view.casters;
  for (const Point& point : frame.points) all.grow(point.position);
  for (const Line& line : frame.lines) {
    all.grow(line.from);
    all.grow(line.to);
  }
  DepthRange range;
  if (!all.empty()) {
    for (int i = 0; i < 8; ++i) {
      range.add(depth(view, all.corner(i)));
    }
  }
  view.nearest = range.near;
  const float distance = (view.target - view.eye).norm();
  view.far = std::max(range.far, distance);
  if (frame.ground) view.far = std::max(view.far, distance + ground_radius(view));
  view.far *= 1.01f;
  // What is nearer than a fiftieth of the way to the target is let in only when a mesh is there;
  // 24 bits of depth tell 1e-4 of the distance apart over a range of 1 to 10^4.
  view.near = std::max(std::min(0.02f * distance, 0.9f * range.near), 1e-4f * view.far);
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  view.projection = projection_matrix(frame.camera.field_of_view, aspect, view.near, view.far);
  view.view_projection = view.projection * view.view;
  return view;
}

float ground_radius(const View& view) {
  const float distance = (view.target - view.eye).norm();
  // Every mesh stands well within, also one that is far from where the camera looks.
  float scene = 0.0f;
  if (!view.casters.empty()) {
    for (int i = 0; i < 8; ++i) {
      scene = std::max(scene, (view.casters.corner(i) - view.target).norm());
    }
  }
  return std::max(2.5f * distance, 2.0f * scene);
}

Region region_of_bodies(const Frame& frame, const View& view,
                        std::span<const SurfaceVertex> surface) {
  if (frame.wireframe || !frame.points.empty() || !frame.lines.empty()) {
    return {0, 0, view.width, view.height};
  }
  if (view.casters.empty()) return {};
  SeenBox box(view);
  for (const SurfaceVertex& vertex : surface) box.add(vertex.position);
  return box.pixels();
}

float to_linear(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

Vec3f to_linear(const Colour& srgb) {
  return srgb.unaryExpr([](float channel) { return to_linear(channel); });
}

}  // namespace pneuma::render

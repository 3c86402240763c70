#include "render/passes/view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pneuma::render {
namespace {

/// The least and greatest distance before the eye of the box's corners.
struct DepthRange {
  float near = std::numeric_limits<float>::infinity();
  float far = 0.0f;

  void add(float depth) {
    near = std::min(near, depth);
    far = std::max(far, depth);
  }
};

/// Whether the ground is drawn where the ray through a point of the picture (-1..1) meets it.
bool meets_ground(const View& view, const Eigen::Vector2f& at) {
  const Vec3f in_view = {at.x() / view.projection(0, 0), at.y() / view.projection(1, 1), -1.0f};
  const Vec3f ray = view.view.topLeftCorner<3, 3>().transpose() * in_view;
  if (ray.z() >= 0.0f || view.eye.z() <= 0.0f) return false;
  const float depth = -view.eye.z() / ray.z();  // the ray is one metre deep
  const Vec3f hit = view.eye + depth * ray;
  return depth > view.near && depth < view.far &&
         (hit - view.target).head<2>().norm() < ground_radius(view);
}

}  // namespace

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
      range.add(-(view.view.row(2) * all.corner(i).homogeneous()).value());
    }
  }
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

int rows_filled_by_ground(const View& view) {
  // The disc of ground is convex: where it holds both ends of two rows, it holds all between.
  const auto holds_row = [&view](int row) {
    const float y = 2.0f * static_cast<float>(row) / static_cast<float>(view.height) - 1.0f;
    return meets_ground(view, {-1.0f, y}) && meets_ground(view, {1.0f, y});
  };
  if (!holds_row(0)) return 0;
  int rows = 0;
  while (rows < view.height && holds_row(rows + 1)) ++rows;
  return rows;
}

float to_linear(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

Vec3f to_linear(const Colour& srgb) {
  return srgb.unaryExpr([](float channel) { return to_linear(channel); });
}

}  // namespace pneuma::render

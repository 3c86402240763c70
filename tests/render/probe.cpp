#include "tests/render/probe.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace pneuma::render {

Pixel pixel_at(const Image& image, int x, int y) {
  const auto i = 3 * static_cast<std::size_t>(y * image.width + x);
  return {image.pixels.at(i), image.pixels.at(i + 1), image.pixels.at(i + 2)};
}

Eigen::Vector2d seen_at(const Camera& camera, const Vec3f& point, int width, int height) {
  const Eigen::Vector3d eye = camera.eye.cast<double>();
  const Eigen::Vector3d forward = (camera.target.cast<double>() - eye).normalized();
  const bool vertical = std::abs(forward.z()) > 0.9999995;
  const Eigen::Vector3d sky = vertical ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d right = forward.cross(sky).normalized();
  const Eigen::Vector3d up = right.cross(forward);
  const Eigen::Vector3d to_point = point.cast<double>() - eye;
  // Pixels per unit of slope.
  const double scale =
      0.5 * height / std::tan(0.5 * camera.field_of_view * std::numbers::pi / 180.0);
  const double depth = to_point.dot(forward);
  return {0.5 * width + scale * to_point.dot(right) / depth,
          0.5 * height - scale * to_point.dot(up) / depth};
}

Pixel pixel_of(const Image& image, const Camera& camera, const Vec3f& point) {
  const Eigen::Vector2d at = seen_at(camera, point, image.width, image.height);
  return pixel_at(image, static_cast<int>(at.x()), static_cast<int>(at.y()));
}

int greatest_difference(const Pixel& a, const Pixel& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

void for_each_difference(const Image& a, const Image& b,
                         const std::function<void(int, int)>& visit) {
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      if (pixel_at(a, x, y) != pixel_at(b, x, y)) visit(x, y);
    }
  }
}

int count_differences(const Image& a, const Image& b) {
  int count = 0;
  for_each_difference(a, b, [&count](int, int) { ++count; });
  return count;
}

Image draw_once(const Frame& frame, const RenderOptions& options) {
  Renderer renderer(options);
  Image image;
  renderer.draw(frame, image);
  return image;
}

RenderOptions small_picture(int samples) {
  RenderOptions options;
  options.width = 320;
  options.height = 240;
  options.samples = samples;
  return options;
}

Frame empty_frame() {
  Frame frame;
  frame.camera = {{0.0f, -10.0f, 0.0f}, Vec3f::Zero(), 40.0f};
  frame.light.shadows = false;
  frame.ground.reset();
  return frame;
}

}  // namespace pneuma::render

#include "app/picture/camera_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/world/touch.h"
#include "sim/inspect/closed_surface.h"

namespace pneuma::app {
namespace {

using sim::Vec3;

/// Whether a body of the world is the scene's body of that name, or one of its copies: "ball",
/// "ball.1", "ball.2".
bool is_called(const std::string& body, const std::string& name) {
  if (!body.starts_with(name)) return false;
  const std::string rest = body.substr(name.size());
  return rest.empty() ||
         (rest.size() > 1 && rest.front() == '.' &&
          std::all_of(rest.begin() + 1, rest.end(), [](char c) { return c >= '0' && c <= '9'; }));
}

/// The derivative at key i, per second: of the chord between its neighbours; at the ends 0.
double slope(const std::vector<scenes::CameraKey>& keys, std::size_t i, std::size_t value) {
  if (i == 0 || i + 1 == keys.size()) return 0.0;
  return (keys[i + 1][value] - keys[i - 1][value]) / (keys[i + 1][0] - keys[i - 1][0]);
}

/// Cubic Hermite interpolation of one value.
double interpolated(const std::vector<scenes::CameraKey>& keys, std::size_t value, double time) {
  if (time <= keys.front()[0]) return keys.front()[value];
  if (time >= keys.back()[0]) return keys.back()[value];
  const auto after =
      std::ranges::find_if(keys, [&](const scenes::CameraKey& key) { return key[0] > time; });
  const auto i = static_cast<std::size_t>(after - keys.begin()) - 1;
  const double span = keys[i + 1][0] - keys[i][0];
  const double s = (time - keys[i][0]) / span;
  const double rest = 1.0 - s;
  return rest * rest * ((1.0 + 2.0 * s) * keys[i][value] + s * span * slope(keys, i, value)) +
         s * s * ((3.0 - 2.0 * s) * keys[i + 1][value] - rest * span * slope(keys, i + 1, value));
}

}  // namespace

render::Camera turned(const render::Camera& camera, double degrees) {
  const auto angle = static_cast<float>(degrees * std::numbers::pi / 180.0);
  render::Camera result = camera;
  const Eigen::AngleAxisf turn(angle, render::Vec3f::UnitZ());
  result.eye = camera.target + turn * render::Vec3f(camera.eye - camera.target);
  return result;
}

render::Camera camera_on_path(const scenes::CameraScene& scene, double time) {
  Vec3 eye;
  Vec3 target;
  for (int axis = 0; axis < 3; ++axis) {
    const auto column = static_cast<std::size_t>(axis);
    eye[axis] = interpolated(scene.path, 1 + column, time);
    target[axis] = interpolated(scene.path, 4 + column, time);
  }
  // Where a path leads the eye through its target, the camera looks on along +y.
  if ((target - eye).norm() < 1e-3) target = eye + Vec3(0.0, 1e-3, 0.0);
  return {eye.cast<float>(), target.cast<float>(), static_cast<float>(scene.field_of_view)};
}

sim::Bounds bounds_of_body(const sim::World& world, const std::string& name) {
  sim::Bounds bounds;
  const int count = static_cast<int>(world.soft.size() + world.rigid.size());
  for (int body = 0; body < count; ++body) {
    if (is_called(sim::body_name(world, body), name)) bounds.include(body_bounds(world, body));
  }
  return bounds;
}

CameraMotion::CameraMotion(const scenes::Scene& scene, const sim::World& start)
    : scene_(scene.camera) {
  if (!scene_.follow.empty()) followed_from_ = bounds_of_body(start, scene_.follow).centre();
}

render::Camera CameraMotion::at(const render::Camera& at_rest, const sim::World& world) const {
  if (!scene_.path.empty()) return camera_on_path(scene_, sim::time(world));
  render::Camera camera = at_rest;
  if (!scene_.follow.empty()) {
    const Vec3 moved = bounds_of_body(world, scene_.follow).centre() - followed_from_;
    camera.eye += moved.cast<float>();
    camera.target += moved.cast<float>();
  }
  if (scene_.orbit == 0.0) return camera;
  return turned(camera, std::fmod(scene_.orbit * sim::time(world), 360.0));
}

}  // namespace pneuma::app

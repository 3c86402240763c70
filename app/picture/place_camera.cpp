#include "app/picture/place_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/picture/camera_motion.h"
#include "app/picture/view_of_bodies.h"
#include "app/world/touch.h"
#include "sim/inspect/closed_surface.h"
#include "sim/inspect/solid.h"

namespace pneuma::app {
namespace {

using sim::Bounds;
using sim::Vec3;

render::Camera fixed_camera(const scenes::CameraScene& scene) {
  render::Camera camera;
  camera.eye = scene.eye->cast<float>();
  camera.target = scene.target->cast<float>();
  camera.field_of_view = static_cast<float>(scene.field_of_view);
  return camera;
}

/// Beside the body that is followed, twice as far as would fill the picture with it.
render::Camera following_camera(const scenes::Scene& scene, const sim::World& start) {
  constexpr double around = 2.0;
  const Bounds body = bounds_of_body(start, scene.camera.follow);
  render::ViewFit fit = make_fit(scene, start, body.centre(), false);
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sign((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                    (corner & 4) != 0 ? 0.5 : -0.5);
    const Vec3 point = body.centre() + around * body.size().cwiseProduct(sign);
    fit.add(point.cast<float>());
  }
  render::Camera camera = fit.camera();
  camera.target = body.centre().cast<float>();
  return camera;
}

/// Whether a ball may be in the cone about the picture's corners.
bool may_be_seen(const scenes::Scene& scene, const Vec3& centre, double radius) {
  const Vec3 to_body = centre - *scene.camera.eye;
  const double distance = to_body.norm();
  if (distance <= radius) return true;
  const double aspect = static_cast<double>(scene.picture.width) / scene.picture.height;
  const double half = 0.5 * scene.camera.field_of_view * std::numbers::pi / 180.0;
  const double corner = std::atan(std::tan(half) * std::hypot(1.0, aspect));
  const Vec3 forward = (*scene.camera.target - *scene.camera.eye).normalized();
  const double angle = std::acos(std::clamp(forward.dot(to_body) / distance, -1.0, 1.0));
  return angle - std::asin(radius / distance) <= corner;
}

bool is_inside(const sim::World& world, int body, const Vec3& point) {
  const std::size_t soft = world.soft.size();
  const sim::Solid solid = sim::at(body) < soft ? sim::Solid(world.soft[sim::at(body)])
                                                : sim::Solid(world.rigid[sim::at(body) - soft]);
  return solid.find_depth(point).has_value();
}

}  // namespace

std::string what_camera_misses(const scenes::Scene& scene, const sim::World& start) {
  if (!scene.camera.eye || !scene.camera.target) return "";
  const int count = static_cast<int>(start.soft.size() + start.rigid.size());
  bool sees_one = false;
  for (int body = 0; body < count; ++body) {
    const Bounds bounds = body_bounds(start, body);
    if (is_inside(start, body, *scene.camera.eye)) {
      return fmt::format(
          "warning: the camera's eye is inside body '{}' at the start; move eye in "
          "[camera], or leave eye and target out",
          sim::body_name(start, body));
    }
    sees_one |= may_be_seen(scene, bounds.centre(), 0.5 * bounds.size().norm());
  }
  if (sees_one) return "";
  return "warning: the camera sees no body at the start; turn target in [camera] towards them, or "
         "leave eye and target out";
}

bool is_left_to_program(const scenes::CameraScene& camera) {
  return camera.path.empty() && !(camera.eye && camera.target) && camera.follow.empty();
}

render::Camera placed_camera(const scenes::Scene& scene, const sim::World& start) {
  if (!scene.camera.path.empty()) return camera_on_path(scene.camera, 0.0);
  if (scene.camera.eye && scene.camera.target) return fixed_camera(scene.camera);
  return following_camera(scene, start);
}

}  // namespace pneuma::app

#include "app/picture/place_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/host/errors.h"
#include "app/world/simulation.h"
#include "app/world/touch.h"
#include "render/frame/camera.h"
#include "sim/inspect/closed_surface.h"
#include "sim/inspect/inspect.h"
#include "sim/inspect/solid.h"

namespace pneuma::app {
namespace {

using sim::Bounds;
using sim::Vec3;

/// How far from where they started, in their own size, bodies are followed. A ball that rolls or
/// bounces stays within; one that falls for ever does not.
constexpr double followed_distance = 3.0;

struct Extent {
  Bounds start;
  Bounds run;
  double largest_body = 0.0;

  void include(const sim::World& world) {
    run.include(sim::bounds(world));
    for (const sim::SoftBody& body : world.soft) {
      largest_body = std::max(largest_body, sim::bounds(body.positions).size().norm());
    }
    for (const sim::RigidBox& box : world.rigid) {
      largest_body = std::max(largest_body, box.size.norm());
    }
  }
};

/// Frames and not steps: what lies between two pictures is seen by nobody.
Extent run_ahead(const scenes::Scene& scene, const sim::World& start, int threads,
                 const OnFrame& on_frame) {
  Extent extent;
  extent.start = sim::bounds(start);
  extent.include(start);
  Simulation simulation(scene, start, threads);
  const std::int64_t last = scenes::frame_count(scene);
  try {
    while (simulation.frame() < last) {
      simulation.advance_frame();
      extent.include(simulation.world());
      if (on_frame) on_frame(simulation.world());
    }
  } catch (const DivergenceError&) {
    // The run itself will come to the same step and report it.
  }
  return extent;
}

render::Camera fixed_camera(const scenes::CameraScene& scene) {
  render::Camera camera;
  camera.eye = scene.eye->cast<float>();
  camera.target = scene.target->cast<float>();
  camera.field_of_view = static_cast<float>(scene.field_of_view);
  return camera;
}

render::Camera automatic_camera(const scenes::Scene& scene, const Bounds& bounds) {
  // The scene counts azimuth from +x, the renderer from -y.
  const render::ViewDirection direction{static_cast<float>(scene.camera.azimuth) + 90.0f,
                                        static_cast<float>(scene.camera.elevation)};
  const float aspect =
      static_cast<float>(scene.picture.width) / static_cast<float>(scene.picture.height);
  const render::Box box{bounds.low.cast<float>(), bounds.high.cast<float>()};
  return render::look_at_bounds(box, direction, static_cast<float>(scene.camera.field_of_view),
                                aspect);
}

std::string flown_away(const Bounds& useful, const Bounds& run) {
  const double beyond =
      std::max((useful.low - run.low).maxCoeff(), (run.high - useful.high).maxCoeff());
  return fmt::format(
      "bodies go as far as {:.3g} m beyond the automatic camera's view, which would be too far "
      "away "
      "to show anything; give eye and target in [camera] to choose",
      beyond);
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

Bounds useful_bounds(const Bounds& start, const Bounds& run, double largest_body) {
  const double size = std::max(start.size().norm(), largest_body);
  const Vec3 reach = Vec3::Constant(followed_distance * size);
  Bounds useful;
  useful.low = run.low.cwiseMax(start.low - reach);
  useful.high = run.high.cwiseMin(start.high + reach);
  return useful;
}

PlacedCamera place_camera(const scenes::Scene& scene, const sim::World& start, int threads,
                          const OnFrame& on_frame) {
  if (scene.camera.eye && scene.camera.target) {
    return {fixed_camera(scene.camera), what_camera_misses(scene, start)};
  }
  const Extent extent = run_ahead(scene, start, threads, on_frame);
  const Bounds useful = useful_bounds(extent.start, extent.run, extent.largest_body);
  PlacedCamera placed{automatic_camera(scene, useful), ""};
  if (useful.low != extent.run.low || useful.high != extent.run.high) {
    placed.notice = flown_away(useful, extent.run);
  }
  return placed;
}

}  // namespace pneuma::app

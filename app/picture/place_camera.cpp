#include "app/picture/place_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/host/errors.h"
#include "app/picture/camera_motion.h"
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

/// What must stay free: the caption's two lines at the bottom, a little at the other sides.
render::Margins margins_of(const scenes::PictureScene& picture) {
  constexpr float side = 0.06f;
  constexpr float caption = 0.23f;
  return {side, side, picture.caption ? caption : side};
}

render::ViewFit make_fit(const scenes::Scene& scene, const Vec3& origin) {
  // The scene counts azimuth from +x, the renderer from -y.
  const render::ViewDirection direction{static_cast<float>(scene.camera.azimuth) + 90.0f,
                                        static_cast<float>(scene.camera.elevation)};
  const float aspect =
      static_cast<float>(scene.picture.width) / static_cast<float>(scene.picture.height);
  return render::ViewFit(direction, static_cast<float>(scene.camera.field_of_view), aspect,
                         margins_of(scene.picture), origin.cast<float>());
}

template <class Visit>
void for_each_vertex(const sim::World& world, const Visit& visit) {
  for (const sim::SoftBody& body : world.soft) {
    for (int v = 0; v < body.positions.size(); ++v) visit(Vec3(body.positions[v]));
  }
  for (const sim::RigidBox& box : world.rigid) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 sign((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                      (corner & 4) != 0 ? 0.5 : -0.5);
      visit(Vec3(box.position + box.orientation * box.size.cwiseProduct(sign)));
    }
  }
}

/// Of what is seen from all around, every point counts as a circle about the vertical through the
/// middle.
void add_circle(const Vec3& point, const Vec3& middle, render::ViewFit& fit) {
  constexpr int sides = 24;
  // Of the polygon's corners, so that it is around the circle.
  const double radius = std::hypot(point.x() - middle.x(), point.y() - middle.y()) /
                        std::cos(std::numbers::pi / sides);
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    fit.add(Vec3(middle.x() + radius * std::cos(angle), middle.y() + radius * std::sin(angle),
                 point.z())
                .cast<float>());
  }
}

/// The widest circles of what is seen from all around: one for each of a few heights.
class Rings {
 public:
  Rings(const Vec3& middle, double low, double high) : middle_(middle), low_(low), high_(high) {}

  void add(const Vec3& point) {
    const double part = (point.z() - low_) / std::max(high_ - low_, 1e-9);
    const auto i = static_cast<std::size_t>(std::clamp(part, 0.0, 1.0) * (count - 1) + 0.5);
    const double radius = std::hypot(point.x() - middle_.x(), point.y() - middle_.y());
    Ring& ring = rings_[i];
    ring.radius = std::max(ring.radius, radius);
    ring.low = std::min(ring.low, point.z());
    ring.high = std::max(ring.high, point.z());
  }

  void add_to(render::ViewFit& fit) const {
    for (const Ring& ring : rings_) {
      if (ring.low > ring.high) continue;
      for (const double z : {ring.low, ring.high}) {
        add_circle({middle_.x() + ring.radius, middle_.y(), z}, middle_, fit);
      }
    }
  }

 private:
  static constexpr std::size_t count = 33;
  struct Ring {
    double radius = 0.0;
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
  };
  Vec3 middle_;
  double low_;
  double high_;
  std::array<Ring, count> rings_;
};

/// A camera that is to be turned: its target lies on the axis.
render::Camera with_target_on_axis(render::Camera camera, const Vec3& middle) {
  const render::Vec3f backward = camera.eye - camera.target;
  const float across = backward.head<2>().norm();
  if (across < 1e-6f) return camera;
  const float to_axis = (camera.eye.head<2>() - middle.cast<float>().head<2>()).norm() / across;
  camera.target = camera.eye - to_axis * backward;
  return camera;
}

/// Frames and not steps: what lies between two pictures is seen by nobody.
template <class Visit>
void run_ahead(const scenes::Scene& scene, const sim::World& start, int threads,
               const OnFrame& on_frame, const Visit& visit) {
  visit(start);
  Simulation simulation(scene, start, threads);
  const std::int64_t last = scenes::frame_count(scene);
  try {
    while (simulation.frame() < last) {
      simulation.advance_frame();
      visit(simulation.world());
      if (on_frame) on_frame(simulation.world());
    }
  } catch (const DivergenceError&) {
    // The run itself will come to the same step and report it.
  }
}

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
  render::ViewFit fit = make_fit(scene, body.centre());
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

render::Camera camera_around(const scenes::Scene& scene, const sim::World& world) {
  const Bounds bounds = sim::bounds(world);
  Rings rings(bounds.centre(), bounds.low.z(), bounds.high.z());
  for_each_vertex(world, [&](const Vec3& point) { rings.add(point); });
  render::ViewFit fit = make_fit(scene, bounds.centre());
  rings.add_to(fit);
  return with_target_on_axis(fit.camera(), bounds.centre());
}

PlacedCamera place_camera(const scenes::Scene& scene, const sim::World& start, int threads,
                          const OnFrame& on_frame) {
  if (!scene.camera.path.empty()) return {camera_on_path(scene.camera, 0.0), ""};
  if (scene.camera.eye && scene.camera.target) {
    return {fixed_camera(scene.camera), what_camera_misses(scene, start)};
  }
  if (!scene.camera.follow.empty()) return {following_camera(scene, start), ""};
  Extent extent;
  extent.start = sim::bounds(start);
  const bool turns = scene.camera.orbit != 0.0;
  const Vec3 middle = extent.start.centre();
  render::ViewFit fit = make_fit(scene, middle);
  const double height = extent.start.size().norm();
  Rings rings(middle, middle.z() - height, middle.z() + height);
  run_ahead(scene, start, threads, on_frame, [&](const sim::World& world) {
    extent.include(world);
    // Of the run so far: a body that grows later on moves what it then shows itself.
    const Bounds useful = useful_bounds(extent.start, extent.run, extent.largest_body);
    for_each_vertex(world, [&](const Vec3& point) {
      const Vec3 shown = point.cwiseMax(useful.low).cwiseMin(useful.high);
      turns ? rings.add(shown) : fit.add(shown.cast<float>());
    });
  });
  if (turns) rings.add_to(fit);
  PlacedCamera placed{fit.camera(), ""};
  if (turns) placed.camera = with_target_on_axis(placed.camera, middle);
  const Bounds useful = useful_bounds(extent.start, extent.run, extent.largest_body);
  if (useful.low != extent.run.low || useful.high != extent.run.high) {
    placed.notice = flown_away(useful, extent.run);
  }
  return placed;
}

}  // namespace pneuma::app

#include "app/picture/view_of_bodies.h"

#include <algorithm>
#include <cmath>

#include "app/picture/choose_elevation.h"
#include "app/world/touch.h"
#include "sim/inspect/closed_surface.h"
#include "sim/inspect/inspect.h"

namespace pneuma::app {
namespace {

using sim::Bounds;
using sim::Vec3;

/// How far from where they started, in their own size, bodies are followed: sideways as far as a
/// ball rolls, where it is still a twentieth of the picture wide; not as far as one falls for ever.
constexpr double followed_sideways = 8.0;
constexpr double followed_up_and_down = 3.0;

/// What must stay free: the caption's two lines at the bottom, a little at the other sides.
render::Margins margins_of(const scenes::PictureScene& picture) {
  constexpr float side = 0.06f;
  constexpr float caption = 0.23f;
  return {side, side, picture.caption ? caption : side};
}

bool draws_ground(const scenes::Scene& scene) {
  return scene.settings.ground && scene.picture.grid;
}

template <class Visit>
void for_each_vertex(const sim::SoftBody& body, const Visit& visit) {
  for (int v = 0; v < body.positions.size(); ++v) visit(Vec3(body.positions[v]));
}

template <class Visit>
void for_each_vertex(const sim::RigidBox& box, const Visit& visit) {
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sign((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                    (corner & 4) != 0 ? 0.5 : -0.5);
    visit(Vec3(box.position + box.orientation * box.size.cwiseProduct(sign)));
  }
}

/// Vertices that are not below the ground, and where edges pass through it.
template <class Visit>
void for_each_point_above_ground(const sim::ClosedSurface& surface, const Visit& visit) {
  const auto place = [&](int v) { return Vec3(surface.points[sim::at(v)].data()); };
  for (const auto& point : surface.points) {
    if (point[2] >= 0.0) visit(Vec3(point.data()));
  }
  for (const auto& [first, second] : surface.edges) {
    const Vec3 a = place(first), b = place(second);
    if ((a.z() < 0.0) == (b.z() < 0.0)) continue;
    const Vec3 passage = a + a.z() / (a.z() - b.z()) * (b - a);
    visit(Vec3(passage.x(), passage.y(), 0.0));
  }
}

/// Calls visit(point) for the points of all bodies that are to be in view. Obstacles may stand in
/// the ground, which hides that part of them where it is drawn. Other bodies are in it for a moment
/// or by a rounding, and count as a whole; so does all where nothing is above it.
template <class Visit>
void for_each_point(const sim::World& world, bool draws_ground, const Visit& visit) {
  bool has_any = false;
  const auto show = [&](const Vec3& point) {
    has_any = true;
    visit(point);
  };
  const auto each = [&](const auto& body, bool is_obstacle) {
    const auto reaches_below = [&] {
      double lowest = 0.0;
      for_each_vertex(body, [&](const Vec3& vertex) { lowest = std::min(lowest, vertex.z()); });
      return lowest < 0.0;
    };
    if (draws_ground && is_obstacle && reaches_below()) {
      for_each_point_above_ground(sim::closed_surface(body), show);
    } else {
      for_each_vertex(body, show);
    }
  };
  for (const sim::SoftBody& body : world.soft) each(body, sim::is_kinematic(body));
  for (const sim::RigidBox& box : world.rigid) each(box, box.is_kinematic);
  if (has_any) return;
  for (const sim::SoftBody& body : world.soft) for_each_vertex(body, visit);
  for (const sim::RigidBox& box : world.rigid) for_each_vertex(box, visit);
}

double largest_body(const sim::World& world) {
  double largest = 0.0;
  for (const sim::SoftBody& body : world.soft) {
    largest = std::max(largest, sim::bounds(body.positions).size().norm());
  }
  for (const sim::RigidBox& box : world.rigid) largest = std::max(largest, box.size.norm());
  return largest;
}

std::optional<std::string> body_beyond(const sim::World& world, const Bounds& shown) {
  const int count = static_cast<int>(world.soft.size() + world.rigid.size());
  for (int body = 0; body < count; ++body) {
    const Bounds bounds = body_bounds(world, body);
    const bool inside = (bounds.low.array() >= shown.low.array()).all() &&
                        (bounds.high.array() <= shown.high.array()).all();
    if (!inside) return sim::body_name(world, body);
  }
  return std::nullopt;
}

/// Of what is seen from all around, every point counts as a circle about the vertical through the
/// middle.
void add_circle(const Vec3& point, const Vec3& middle, render::ViewFit& fit) {
  const double radius = std::hypot(point.x() - middle.x(), point.y() - middle.y());
  fit.add_circle(Vec3(middle.x(), middle.y(), point.z()).cast<float>(), static_cast<float>(radius));
}

/// A camera that is to be turned: its target lies on the axis.
render::Camera with_target_on_axis(render::Camera camera, const Vec3& middle) {
  const render::Vec3f backward = camera.eye - camera.target;
  const float across = backward.head<2>().norm();
  if (across < 1e-6f) return camera;
  const float to_axis = (camera.eye.head<2>() - middle.cast<float>().head<2>()).norm() / across;
  camera.target = camera.eye - to_axis * backward;
  return camera;
}

}  // namespace

render::ViewFit make_fit(const scenes::Scene& scene, const sim::World& world, const Vec3& origin,
                         bool from_all_around) {
  // The scene counts azimuth from +x, the renderer from -y.
  const render::ViewDirection direction{
      static_cast<float>(scene.camera.azimuth) + 90.0f,
      static_cast<float>(choose_elevation(scene, world, from_all_around))};
  const float aspect =
      static_cast<float>(scene.picture.width) / static_cast<float>(scene.picture.height);
  return render::ViewFit(direction, static_cast<float>(scene.camera.field_of_view), aspect,
                         margins_of(scene.picture), origin.cast<float>());
}

Bounds worth_showing(const Bounds& start, double largest_body) {
  const double size = std::max(start.size().norm(), largest_body);
  const Vec3 reach = size * Vec3(followed_sideways, followed_sideways, followed_up_and_down);
  return {start.low - reach, start.high + reach};
}

ViewOfBodies::ViewOfBodies(const scenes::Scene& scene, const sim::World& start)
    : draws_ground_(draws_ground(scene)),
      start_(sim::bounds(start)),
      turns_(scene.camera.orbit != 0.0),
      fit_(make_fit(scene, start, start_.centre(), turns_)) {}

std::optional<std::string> ViewOfBodies::add(const sim::World& world) {
  const Bounds shown = worth_showing(start_, largest_body(world));
  for_each_point(world, draws_ground_, [&](const Vec3& point) {
    add_point(point.cwiseMax(shown.low).cwiseMin(shown.high));
  });
  return body_beyond(world, shown);
}

void ViewOfBodies::add_point(const Vec3& point) {
  turns_ ? add_circle(point, start_.centre(), fit_) : fit_.add(point.cast<float>());
}

render::Camera ViewOfBodies::camera() const {
  return turns_ ? with_target_on_axis(fit_.camera(), start_.centre()) : fit_.camera();
}

render::Camera camera_around(const scenes::Scene& scene, const sim::World& world) {
  const Vec3 middle = sim::bounds(world).centre();
  render::ViewFit fit = make_fit(scene, world, middle, true);
  for_each_point(world, draws_ground(scene),
                 [&](const Vec3& point) { add_circle(point, middle, fit); });
  return with_target_on_axis(fit.camera(), middle);
}

}  // namespace pneuma::app

#include "app/picture/choose_elevation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "app/world/touch.h"
#include "sim/inspect/closed_surface.h"

namespace pneuma::app {
namespace {

using sim::Bounds;
using sim::Vec3;

constexpr double usual = 22.0, highest = 82.0, interval = 6.0;  // degrees
/// Of the places: what lies behind another body is no reason to look from above.
constexpr double share_to_see = 0.75;
/// So many bodies of a scene stand for all.
constexpr int most_samples = 32;
/// From all around.
constexpr int azimuths_around = 8;

/// m along a unit direction to where a line from a point passes the plane of a triangle within it;
/// none behind the point (Moeller and Trumbore 1997).
std::optional<double> crossing(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point,
                               const Vec3& direction) {
  const Vec3 along_b = b - a, along_c = c - a;
  const Vec3 across = direction.cross(along_c);
  const double volume = along_b.dot(across);
  if (volume == 0.0) return std::nullopt;
  const Vec3 from_a = point - a;
  const double u = from_a.dot(across) / volume;
  if (u < 0.0 || u > 1.0) return std::nullopt;
  const Vec3 turned = from_a.cross(along_b);
  const double v = direction.dot(turned) / volume;
  if (v < 0.0 || u + v > 1.0) return std::nullopt;
  const double way = along_c.dot(turned) / volume;
  return way > 0.0 ? std::optional(way) : std::nullopt;
}

/// Of the bodies of a world, soft ones first: whether they are drawn with their surface.
std::vector<bool> have_surfaces(const scenes::Scene& scene) {
  std::vector<bool> soft, rigid;
  for (const scenes::BodyScene& body : scene.bodies) {
    std::vector<bool>& of_kind = scenes::is_box(body) ? rigid : soft;
    of_kind.insert(of_kind.end(), static_cast<std::size_t>(scenes::copy_count(body)),
                   body.drawn == scenes::Drawn::surface);
  }
  soft.insert(soft.end(), rigid.begin(), rigid.end());
  return soft;
}

struct Obstacle {
  explicit Obstacle(sim::ClosedSurface closed) : surface(std::move(closed)) {
    for (const auto& point : surface.points) bounds.include(Vec3(point.data()));
  }

  /// Whether the line from a point may meet it: whether it comes into the sphere about its bounds.
  bool may_be_met(const Vec3& point, const Vec3& direction) const {
    const Vec3 there = bounds.centre() - point;
    const double radius = 0.5 * bounds.size().norm(), ahead = there.dot(direction);
    return ahead > -radius && (there - ahead * direction).squaredNorm() <= radius * radius;
  }

  /// m to where the line meets it, if it does; to the nearest such place, or to any.
  std::optional<double> way_to(const Vec3& point, const Vec3& direction, bool any) const {
    std::optional<double> least;
    if (!may_be_met(point, direction)) return least;
    for (const auto& [a, b, c] : surface.triangles) {
      const auto corner = [&](int i) { return Vec3(surface.points[sim::at(i)].data()); };
      const auto way = crossing(corner(a), corner(b), corner(c), point, direction);
      if (way && (!least || *way < *least)) least = way;
      if (least && any) return least;
    }
    return least;
  }

  sim::ClosedSurface surface;
  Bounds bounds;
};

/// What no force moves.
class Obstacles {
 public:
  Obstacles(const scenes::Scene& scene, const sim::World& world) : ground_(world.settings.ground) {
    const std::vector<bool> are_seen = have_surfaces(scene);
    const auto add = [&](int body, const auto& shape) {
      if (!sim::is_kinematic(world, body)) return;
      auto& of_kind = are_seen[sim::at(body)] ? opaque_ : seen_through_;
      of_kind.emplace_back(sim::closed_surface(shape));
    };
    int body = 0;
    for (const sim::SoftBody& soft : world.soft) add(body++, soft);
    for (const sim::RigidBox& box : world.rigid) add(body++, box);
  }

  bool hide_nothing() const { return opaque_.empty(); }

  bool hide(const Vec3& point, const Vec3& direction) const {
    return std::ranges::any_of(opaque_, [&](const Obstacle& obstacle) {
      return obstacle.way_to(point, direction, true).has_value();
    });
  }

  /// m, to the ground too; infinite where nothing is in the way.
  double free_way(const Vec3& point, const Vec3& direction) const {
    double least = std::numeric_limits<double>::infinity();
    if (ground_ && direction.z() < 0.0) least = std::max(0.0, point.z() / -direction.z());
    for (const auto* kind : {&opaque_, &seen_through_}) {
      for (const Obstacle& obstacle : *kind) {
        least = std::min(least, obstacle.way_to(point, direction, false).value_or(least));
      }
    }
    return least;
  }

 private:
  std::vector<Obstacle> opaque_, seen_through_;
  bool ground_;
};

/// Of bodies that can move: the middle and the top of each where it comes to lie, or where it is at
/// the start if it falls for ever.
std::vector<Vec3> places_to_see(const sim::World& world, const Obstacles& obstacles) {
  std::vector<int> bodies;
  for (int i = 0; i < sim::body_count(world); ++i) {
    if (!sim::is_kinematic(world, i)) bodies.push_back(i);
  }
  const Vec3 down = world.settings.gravity.normalized();
  std::vector<Vec3> places;
  const int count = static_cast<int>(bodies.size()), samples = std::min(count, most_samples);
  for (int i = 0; i < samples; ++i) {
    const Bounds bounds = body_bounds(world, bodies[sim::at(i * count / samples)]);
    Vec3 middle = bounds.centre();
    const double way = down.isZero(0.0) ? 0.0 : obstacles.free_way(middle, down);
    const double radius = 0.5 * bounds.size().dot(down.cwiseAbs());
    if (std::isfinite(way) && way > radius) middle += (way - radius) * down;
    places.push_back(middle);
    places.push_back(middle - 0.9 * radius * down);
  }
  return places;
}

Vec3 direction_to_camera(double azimuth, double elevation) {
  constexpr double degree = std::numbers::pi / 180.0;
  const double across = std::cos(degree * elevation);
  return {across * std::cos(degree * azimuth), across * std::sin(degree * azimuth),
          std::sin(degree * elevation)};
}

}  // namespace

double choose_elevation(const scenes::Scene& scene, const sim::World& world, bool from_all_around) {
  const scenes::CameraScene& camera = scene.camera;
  if (camera.elevation) return *camera.elevation;
  if (!camera.follow.empty()) return usual;
  const Obstacles obstacles(scene, world);
  if (obstacles.hide_nothing()) return usual;
  const std::vector<Vec3> places = places_to_see(world, obstacles);
  const int azimuths = from_all_around ? azimuths_around : 1;
  const double all = static_cast<double>(places.size()) * azimuths;
  double best = usual, most = 0.0;
  for (double elevation = usual; elevation <= highest && all > 0.0; elevation += interval) {
    double seen = 0.0;
    for (int i = 0; i < azimuths; ++i) {
      const Vec3 direction = direction_to_camera(camera.azimuth + 360.0 * i / azimuths, elevation);
      seen += static_cast<double>(std::ranges::count_if(
          places, [&](const Vec3& place) { return !obstacles.hide(place, direction); }));
    }
    if (seen >= share_to_see * all) return elevation;
    if (seen > most) {
      most = seen;
      best = elevation;
    }
  }
  return best;
}

}  // namespace pneuma::app

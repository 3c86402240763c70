#include "app/picture/choose_elevation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "app/world/touch.h"
#include "sim/inspect/closed_surface.h"

namespace pneuma::app {
namespace {

using sim::Bounds;
using sim::Vec3;

constexpr double usual = 22.0, highest = 70.0, interval = 6.0;  // degrees
/// Of the places of bodies, so that what lies behind another one is no reason to look from above.
constexpr double share_to_see = 0.6;
/// So many bodies of a scene stand for all.
constexpr int most_samples = 64;

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

/// What no force moves.
class Obstacles {
 public:
  Obstacles(const scenes::Scene& scene, const sim::World& world) : ground_(world.settings.ground) {
    const std::vector<bool> are_seen = have_surfaces(scene);
    const auto add = [&](int body, const auto& shape) {
      if (!sim::is_kinematic(world, body)) return;
      auto& of_kind = are_seen[sim::at(body)] ? surfaces_ : seen_through_;
      of_kind.push_back(sim::closed_surface(shape));
    };
    int body = 0;
    for (const sim::SoftBody& soft : world.soft) add(body++, soft);
    for (const sim::RigidBox& box : world.rigid) add(body++, box);
  }

  bool hide_nothing() const { return surfaces_.empty(); }

  bool hide(const Vec3& point, const Vec3& direction) const {
    return std::isfinite(way_to(surfaces_, point, direction));
  }

  /// m, to the ground too; infinite where nothing is in the way.
  double free_way(const Vec3& point, const Vec3& direction) const {
    const double to_surfaces =
        std::min(way_to(surfaces_, point, direction), way_to(seen_through_, point, direction));
    if (!ground_ || direction.z() >= 0.0) return to_surfaces;
    return std::min(to_surfaces, std::max(0.0, point.z() / -direction.z()));
  }

 private:
  static double way_to(const std::vector<sim::ClosedSurface>& surfaces, const Vec3& point,
                       const Vec3& direction) {
    double least = std::numeric_limits<double>::infinity();
    for (const sim::ClosedSurface& surface : surfaces) {
      for (const auto& [a, b, c] : surface.triangles) {
        const auto corner = [&](int i) { return Vec3(surface.points[sim::at(i)].data()); };
        const auto way = crossing(corner(a), corner(b), corner(c), point, direction);
        if (way) least = std::min(least, *way);
      }
    }
    return least;
  }

  std::vector<sim::ClosedSurface> surfaces_, seen_through_;
  bool ground_;
};

/// Of bodies that can move: the middle of each at the start, and where it comes to lie.
std::vector<Vec3> places_to_see(const sim::World& world, const Obstacles& obstacles) {
  std::vector<int> bodies;
  for (int i = 0; i < static_cast<int>(world.soft.size() + world.rigid.size()); ++i) {
    if (!sim::is_kinematic(world, i)) bodies.push_back(i);
  }
  const Vec3 down = world.settings.gravity.normalized();
  std::vector<Vec3> places;
  const int count = static_cast<int>(bodies.size()), samples = std::min(count, most_samples);
  for (int i = 0; i < samples; ++i) {
    const Bounds bounds = body_bounds(world, bodies[sim::at(i * count / samples)]);
    const Vec3 middle = bounds.centre();
    places.push_back(middle);
    const double way = obstacles.free_way(middle, down);
    const double radius = 0.5 * bounds.size().dot(down.cwiseAbs());
    if (std::isfinite(way) && way > radius) places.push_back(middle + (way - radius) * down);
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

double choose_elevation(const scenes::Scene& scene, const sim::World& world) {
  if (scene.camera.elevation) return *scene.camera.elevation;
  const Obstacles obstacles(scene, world);
  if (obstacles.hide_nothing()) return usual;
  const std::vector<Vec3> places = places_to_see(world, obstacles);
  const auto share_seen = [&](double elevation) {
    const Vec3 direction = direction_to_camera(scene.camera.azimuth, elevation);
    const auto seen = std::ranges::count_if(
        places, [&](const Vec3& place) { return !obstacles.hide(place, direction); });
    return static_cast<double>(seen) / static_cast<double>(places.size());
  };
  if (places.empty()) return usual;
  double best = usual, most = 0.0;
  for (double elevation = usual; elevation <= highest; elevation += interval) {
    const double share = share_seen(elevation);
    if (share >= share_to_see) return elevation;
    if (share > most) {
      most = share;
      best = elevation;
    }
  }
  return best;
}

}  // namespace pneuma::app

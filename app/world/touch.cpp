#include "app/world/touch.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "sim/base/text.h"
#include "sim/inspect/overlap.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"
#include "sim/world/sleep.h"

namespace pneuma::app {
namespace {

using sim::Vec3;

constexpr double crushed_share = 0.5;  // of the volume at rest
constexpr double near_share = 0.02;    // of the diagonal

/// What does not give way and touches a body.
struct Wall {
  std::string name;
  Vec3 direction;  // to it: of an axis
  bool is_moved = false;
};

bool is_moved(const sim::World& world, int body) {
  const std::size_t soft = world.soft.size();
  if (sim::moves(world, body)) return true;
  return sim::at(body) < soft ? world.soft[sim::at(body)].pins->are_moved
                              : world.rigid[sim::at(body) - soft].motion != nullptr;
}

/// Along the axis on which the bounds are furthest apart; none unless they touch there.
std::optional<Vec3> direction_to(const sim::Bounds& own, const sim::Bounds& other, double reach) {
  double furthest = -reach;
  std::optional<Vec3> direction;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const double gap =
          side < 0.0 ? own.low[axis] - other.high[axis] : other.low[axis] - own.high[axis];
      if (gap > reach) return std::nullopt;
      if (gap <= furthest) continue;
      furthest = gap;
      direction = side * Vec3::Unit(axis);
    }
  }
  return direction;
}

std::vector<Wall> walls_of(const sim::World& world, const sim::SoftBody& body) {
  const sim::Bounds own = sim::bounds(body.positions);
  const double reach = near_share * own.size().norm();
  std::vector<Wall> walls;
  const auto add = [&](const std::string& name, const sim::Bounds& bounds, bool is_moved) {
    if (const auto direction = direction_to(own, bounds, reach)) {
      walls.push_back({name, *direction, is_moved});
    }
  };
  const int count = static_cast<int>(world.soft.size() + world.rigid.size());
  for (int other = 0; other < count; ++other) {
    if (!sim::is_kinematic(world, other)) continue;
    add(sim::body_name(world, other), body_bounds(world, other), is_moved(world, other));
  }
  if (world.settings.ground) {
    sim::Bounds under = own;
    under.low.z() = under.low.z() - own.size().z();
    under.high.z() = 0.0;
    add("the ground", under, false);
  }
  return walls;
}

std::string crushed_body(const sim::World& world, const sim::SoftBody& body) {
  if (sim::is_kinematic(body)) return "";
  const sim::MeshTopology& topology = body.mesh->topology;
  const double left = sim::volume(topology, body.positions);
  const double at_rest = sim::volume(topology, body.mesh->rest_positions);
  if (!(left < crushed_share * at_rest)) return "";
  const std::vector<Wall> walls = walls_of(world, body);
  for (const Wall& moved : walls) {
    if (!moved.is_moved) continue;
    for (const Wall& other : walls) {
      if (moved.direction != -other.direction) continue;
      return fmt::format("{} is crushed between {} and {}, to {} of its {} m^3", body.name,
                         moved.name, other.name, base::text(left), base::text(at_rest));
    }
  }
  return "";
}

}  // namespace

sim::Bounds body_bounds(const sim::World& world, int body) {
  const std::size_t soft = world.soft.size();
  if (sim::at(body) < soft) return sim::bounds(world.soft[sim::at(body)].positions);
  const sim::RigidBox& box = world.rigid[sim::at(body) - soft];
  sim::Bounds bounds;
  for (const sim::Vec3& corner : sim::make_box(box.size, 1).vertices) {
    bounds.include(box.position + box.orientation * corner);
  }
  return bounds;
}

double least_extent(const sim::World& world, int body) {
  const std::size_t soft = world.soft.size();
  if (sim::at(body) >= soft) return world.rigid[sim::at(body) - soft].size.minCoeff();
  return body_bounds(world, body).size().minCoeff();
}

double touch_depth(const sim::World& world, int first, int second) {
  constexpr double pile = 2.0, of_extent = 0.05, rounding = 1e-6;
  const double least = std::min(least_extent(world, first), least_extent(world, second));
  const double dt = sim::time_step(world.settings);
  const double fall = world.settings.gravity.norm() * dt * dt;
  return std::min(pile * fall, of_extent * least) + rounding * least;
}

bool is_beyond_touch(const sim::World& world, int first, int second) {
  return sim::overlap_depth(world, first, second) > touch_depth(world, first, second);
}

std::vector<sim::CrossingPair> crossings_beyond_touch(const sim::World& world,
                                                      const sim::Crossings& crossings) {
  std::vector<sim::CrossingPair> deep;
  for (const sim::CrossingPair& pair : crossings.pairs) {
    if (pair.first == pair.second) continue;
    if (is_beyond_touch(world, pair.first, pair.second)) deep.push_back(pair);
  }
  return deep;
}

std::string crushed_between(const sim::World& world, const std::string& name, bool any) {
  for (const sim::SoftBody& body : world.soft) {
    if (!any && body.name != name) continue;
    const std::string crushed = crushed_body(world, body);
    if (!crushed.empty()) return crushed;
  }
  return "";
}

}  // namespace pneuma::app

#include "app/world/touch.h"

#include <algorithm>

#include "sim/inspect/overlap.h"
#include "sim/mesh/primitives.h"

namespace pneuma::app {

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

}  // namespace pneuma::app

#include "sim/potential/start_distance.h"

#include <algorithm>

#include "sim/potential/contact_potential.h"

namespace pneuma::sim {
namespace {

/// Of the reach: nearer, and the force is a matter of rounding.
constexpr double least_start_fraction = 1e-3;

}  // namespace

std::optional<NearStart> find_nearest_start(const World& world) {
  const ContactSurfaces surfaces(world);
  VertexArray positions(surfaces.vertex_count()), velocities(surfaces.vertex_count());
  surfaces.gather(world, positions, velocities);
  surfaces.place_boxes(world, positions);
  std::vector<ContactPair> pairs;
  PairFinder(surfaces).find(positions, positions, 0.0, pairs);
  std::vector<ActiveContact> active;
  find_active(surfaces, positions, pairs, active);
  const auto of_reach = [&](const ActiveContact& contact) {
    return contact.point.distance / surfaces[contact.first].reach;
  };
  const auto nearest = std::ranges::min_element(active, {}, of_reach);
  if (nearest == active.end()) return std::nullopt;
  const double reach = surfaces[nearest->first].reach;
  const double below = nearest->second < 0 ? reach : 0.0;  // where the ground's distance is zero
  return NearStart{nearest->first, nearest->second, nearest->point.distance - below, reach};
}

std::optional<NearStart> find_touching_start(const World& world) {
  const auto nearest = find_nearest_start(world);
  if (!nearest) return std::nullopt;
  const double below = nearest->second < 0 ? nearest->reach : 0.0;
  if (nearest->distance + below > least_start_fraction * nearest->reach) return std::nullopt;
  return nearest;
}

}  // namespace pneuma::sim

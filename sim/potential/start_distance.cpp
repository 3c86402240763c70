#include "sim/potential/start_distance.h"

#include "sim/potential/contact_potential.h"

namespace pneuma::sim {
namespace {

/// Of the reach: nearer, and the force is a matter of rounding.
constexpr double least_start_fraction = 1e-3;

}  // namespace

std::optional<TouchingStart> find_touching_start(const World& world) {
  const ContactSurfaces surfaces(world);
  VertexArray positions(surfaces.vertex_count()), velocities(surfaces.vertex_count());
  surfaces.gather(world, positions, velocities);
  surfaces.place_boxes(world, positions);
  std::vector<ContactPair> pairs;
  PairFinder(surfaces).find(positions, positions, 0.0, pairs);
  std::vector<ActiveContact> active;
  find_active(surfaces, positions, pairs, active);
  for (const ActiveContact& contact : active) {
    const double reach = surfaces[contact.first].reach;
    if (contact.point.distance > least_start_fraction * reach) continue;
    const double distance =
        contact.second < 0 ? contact.point.distance - reach : contact.point.distance;
    return TouchingStart{contact.first, contact.second, distance, reach};
  }
  return std::nullopt;
}

}  // namespace pneuma::sim

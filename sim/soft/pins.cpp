#include "sim/soft/pins.h"

#include <algorithm>
#include <utility>

namespace pneuma::sim {
namespace {

/// Calls visit(vertex, place) with where the motion puts each vertex that follows it, m.
template <class Visit>
void for_each_followed(const SoftBody& body, double time, const Visit& visit) {
  if (!body.pins || !body.pins->are_moved) return;
  const PinPlaces places(*body.pins, time);
  for (int v = 0; v < body.positions.size(); ++v) {
    if (body.pins->follows[at(v)] != 0) visit(v, places[v]);
  }
}

}  // namespace

bool keeps_shape(const SoftBody& body) {
  if (!is_kinematic(body)) return false;
  const auto follows = [](std::uint8_t vertex) { return vertex != 0; };
  return !body.pins->are_moved || std::ranges::all_of(body.pins->follows, follows);
}

std::shared_ptr<const Pins> make_pins(const VertexArray& positions,
                                      std::vector<std::uint8_t> is_pinned,
                                      std::vector<std::uint8_t> follows, GivenMotion motion) {
  const auto is_set = [](std::uint8_t value) { return value != 0; };
  Pins pins;
  pins.are_all = std::ranges::all_of(is_pinned, is_set);
  pins.are_moved = std::ranges::any_of(follows, is_set);
  pins.is_pinned = std::move(is_pinned);
  pins.follows = std::move(follows);
  pins.start = positions;
  pins.motion = std::move(motion);
  return std::make_shared<const Pins>(std::move(pins));
}

void aim_pins(SoftBody& body, const Settings& settings, std::int64_t steps) {
  const double step = time_step(settings);
  const double end = static_cast<double>(steps + 1) / settings.steps_per_second;
  for_each_followed(body, end, [&](int v, const Vec3& place) {
    body.velocities[v] = (place - Vec3(body.positions[v])) / step;
  });
}

void place_pins(SoftBody& body, double time) {
  for_each_followed(body, time, [&](int v, const Vec3& place) { body.positions[v] = place; });
}

void hold_pins(SoftBody& body, const SoftState& start, double step) {
  if (!body.pins || is_still(body)) return;
  for (int v = 0; v < body.positions.size(); ++v) {
    if (body.pins->is_pinned[at(v)] == 0) continue;
    const Vec3 velocity = start.velocities[v];
    body.velocities[v] = velocity;
    body.positions[v] = Vec3(start.positions[v]) + step * velocity;
  }
}

}  // namespace pneuma::sim

#include "sim/response/carried_boxes.h"

#include <algorithm>

#include "sim/world/sleep.h"

namespace pneuma::sim {

CarriedBoxes::CarriedBoxes(const World& world)
    : near_(at(body_count(world))), has_soft_(near_.size()), is_carried_(world.rigid.size()) {}

/// Nothing reaches through what stands still, sleeps or is moved.
void CarriedBoxes::find(const World& world, std::span<const BodyPair> pairs) {
  std::ranges::fill(is_carried_, std::uint8_t{0});
  near_.reset();
  for (const auto& [first, second] : pairs) {
    if (second < 0 || is_fixed(world, first) || is_fixed(world, second)) continue;
    near_.unite(first, second);
  }
  std::ranges::fill(has_soft_, std::uint8_t{0});
  for (int i = 0; i < soft_count(world); ++i) has_soft_[at(near_.find(i))] = 1;
  for (int i = soft_count(world); i < body_count(world); ++i) {
    const bool is_carried = !is_fixed(world, i) && has_soft_[at(near_.find(i))] != 0;
    is_carried_[at(i - soft_count(world))] = is_carried ? 1 : 0;
  }
}

bool moves_by_new_velocity(Integrator integrator) {
  return integrator == Integrator::martin || integrator == Integrator::symplectic_euler ||
         integrator == Integrator::implicit_euler;
}

Vec3 fall_within(double step, Integrator integrator, const Vec3& gravity) {
  return (moves_by_new_velocity(integrator) ? 1.0 : 0.5) * step * step * gravity;
}

}  // namespace pneuma::sim

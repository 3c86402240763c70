// Which boxes soft bodies may carry, directly or on other boxes (ERRATA row 74).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/base/disjoint_sets.h"
#include "sim/collision/sweep_and_prune.h"
#include "sim/world/world.h"

namespace pneuma::sim {

class CarriedBoxes {
 public:
  explicit CarriedBoxes(const World& world);

  /// `pairs`: of bodies near each other, or near the ground (-1).
  void find(const World& world, std::span<const BodyPair> pairs);
  /// Of the last call. `box`: index into World::rigid.
  bool is_carried(int box) const { return is_carried_[at(box)] != 0; }

 private:
  base::DisjointSets near_;               // bodies near each other, directly or through others
  std::vector<std::uint8_t> has_soft_;    // per first body of a set
  std::vector<std::uint8_t> is_carried_;  // per box
};

/// Whether the velocity at the end of a step moves soft bodies in all of it.
bool moves_by_new_velocity(Integrator integrator);

/// m, by which gravity displaces a soft body within a step (s) by this integrator, besides what its
/// velocity at the start does: half of g h^2, or all of it where the new velocity moves it.
Vec3 fall_within(double step, Integrator integrator, const Vec3& gravity);

}  // namespace pneuma::sim

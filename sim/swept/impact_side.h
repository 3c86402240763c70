// What takes part in an impact: boxes, or one and the ground.
#pragma once

#include <array>
#include <cstddef>

#include "sim/collision/oriented_box.h"
#include "sim/rigid/rigid_state.h"
#include "sim/swept/swept_impulse.h"

namespace pneuma::sim {

/// A plane that bears a face of a box, which slides on it.
struct ImpactFloor {
  Vec3 normal = Vec3::Zero();    // unit, out of it; zero: there is none
  Vec3 velocity = Vec3::Zero();  // m/s, of what is moved; it does not turn
  double friction = 0.0;
  std::array<Vec3, 8> points;  // m, where it bears the box: in its own axes, about its centre
  std::size_t count = 0;
};

/// m/s: what moves no faster against its floor, along its normal, stays on it.
inline constexpr double speed_of_rest = 1e-3;

/// A box that moves freely, or along a floor; one that stands still or is moved; or the ground.
class ImpactSide {
 public:
  /// Refers to the box; `start`: its state at the start of the step. On a floor it moves along it,
  /// turns about its normal only, and feels gravity along it, until an impact lifts it.
  ImpactSide(const RigidBox& box, const RigidState& start, bool moves, const Vec3& gravity,
             const ImpactFloor& floor = {});
  /// The ground.
  ImpactSide() = default;

  bool is_ground() const { return box_ == nullptr; }
  /// Impulses move it.
  bool moves() const { return moves_; }
  const RigidBox& box() const { return *box_; }

  /// The state after `duration` s of free motion from the start of the step. Gravity moves it, and
  /// its velocity stays what it is without gravity and drag.
  RigidState after(double duration) const;
  /// The state at `time` s since the start of the step, of one that was `from` at `since` when
  /// impulses changed it.
  RigidState after(const RigidState& from, const BoxChange& change, double since,
                   double time) const;

  OrientedBox placed(const RigidState& state) const;
  Bounds bounds(const RigidState& state) const { return sim::bounds(placed(state)); }
  double half_diagonal() const { return 0.5 * box_->size.norm(); }
  const RigidState& start() const { return start_; }
  /// m/s^2, of what moves; on a floor, along it.
  const Vec3& gravity() const { return gravity_; }
  /// m/s^2, that the floor bears.
  const Vec3& borne_gravity() const { return borne_gravity_; }
  /// Whether it does in this state, after an impact.
  bool leaves_floor(const RigidState& state) const {
    return is_on_floor() && floor_.normal.dot(state.velocity - floor_.velocity) > speed_of_rest;
  }
  const ImpactFloor& floor() const { return floor_; }
  bool is_on_floor() const { return floor_.count > 0; }
  /// m, of its highest point in this state along a direction, which has the size 1.
  double height(const RigidState& state, const Vec3& up) const;
  /// m, along the floor's normal.
  double floor_height() const { return -height(start_, -floor_.normal); }
  /// m, by which the box in this state, `time` s after the start, is deeper in its floor than then.
  double depth_in_floor(const RigidState& state, double time) const {
    return floor_height() + time * floor_.normal.dot(floor_.velocity) +
           height(state, -floor_.normal);
  }
  /// rad/s, at most.
  double fastest_turn() const;

 private:
  RigidState moved(const RigidState& from, const Vec3& angular_momentum, double since,
                   double time) const;

  const RigidBox* box_ = nullptr;
  ImpactFloor floor_;
  Vec3 gravity_ = Vec3::Zero();
  Vec3 borne_gravity_ = Vec3::Zero();
  RigidState start_;
  bool moves_ = false;
  Vec3 spin_ = Vec3::Zero();
};

}  // namespace pneuma::sim

// One impact of boxes that meet nothing else in a step.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/collision/oriented_box.h"
#include "sim/rigid/rigid_state.h"
#include "sim/swept/impact_path.h"
#include "sim/world/contact_material.h"

namespace pneuma::sim {

/// A box that moves freely, one that nothing moves, or the ground.
class ImpactSide {
 public:
  /// Refers to the box; `start`: its state at the start of the step.
  ImpactSide(const RigidBox& box, const RigidState& start, bool moves, const Vec3& gravity);
  /// The ground.
  ImpactSide() = default;

  bool is_ground() const { return box_ == nullptr; }
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
  /// rad/s, at most.
  double fastest_turn() const;

 private:
  RigidState moved(const RigidState& from, const Vec3& angular_momentum, double since,
                   double time) const;

  const RigidBox* box_ = nullptr;
  Vec3 gravity_ = Vec3::Zero();
  RigidState start_;
  bool moves_ = false;
  Vec3 spin_ = Vec3::Zero();
};

/// Its first side moves. Its points are where the sides are nearest when it happens.
class FreeImpact {
 public:
  /// In a step of `step` s, of sides that keep the distance `wanted` (m). Points no further from
  /// being hit than `together` (m) are hit as well.
  FreeImpact(const std::array<ImpactSide, 2>& sides, double wanted, double together, double step,
             const Vec3& gravity)
      : sides_(sides),
        wanted_(wanted),
        together_(together),
        step_(step),
        gravity_(sides[1].moves() ? Vec3::Zero() : gravity) {}

  /// Finds the time of impact, or that the sides pass each other; neither, if they begin too near
  /// or it takes too long.
  enum class Result { none, hit, pass };
  Result find_time();
  /// Fills the points of the impact and their impulses. False unless all of them bounce.
  bool find_points(const ContactMaterial& material, std::vector<SweptImpulse>& impulses,
                   std::vector<ImpactPoint>& points);
  /// Finds how the step ends, and the work, from impulses that are solved for.
  void finish(std::span<const ImpactPoint> points);

  const std::array<ImpactSide, 2>& sides() const { return sides_; }
  const RigidState& at_impact(std::size_t side) const { return states_[side]; }
  /// With the velocity that it has without gravity and drag.
  const RigidState& at_end(std::size_t side) const { return ends_[side]; }
  double time_left() const { return step_ - time_; }  // s
  double work() const { return work_; }               // J
  /// Whether the sides would meet again: they overlap in the time left, or are nearer than `near`
  /// (m) at its end and approach.
  bool meets_again(double near) const;

 private:
  struct Separation {
    double distance = 0.0;      // m
    Vec3 axis = Vec3::UnitZ();  // unit, from the second side to the first
  };
  Separation separation(double time) const;
  double fastest(const Vec3& axis) const;
  double motion_left() const;
  bool overlap_after(double duration) const;
  template <class Visit>
  void for_each_near(const std::array<RigidState, 2>& states, double reach,
                     const Visit& visit) const;
  SweptSide side(std::size_t i, const Vec3& point);
  Vec3 velocity_at(const Vec3& point, const std::array<RigidState, 2>& states) const;

  const std::array<ImpactSide, 2>& sides_;
  double wanted_;
  double together_;
  double step_;
  Vec3 gravity_;                      // m/s^2, of the first side against the second
  double time_ = 0.0;                 // of the impact, s since the start of the step
  std::array<RigidState, 2> states_;  // then
  std::array<RigidState, 2> ends_;
  std::array<BoxChange, 2> changes_;
  double work_ = 0.0;
};

}  // namespace pneuma::sim

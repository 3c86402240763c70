// One impact of boxes that meet nothing else in a step, but floors that they slide on.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/swept/impact_path.h"
#include "sim/swept/impact_side.h"
#include "sim/world/contact_material.h"

namespace pneuma::sim {

/// Its first side moves. Its points are where the sides are nearest when it happens.
class FreeImpact {
 public:
  /// In a step of `step` s, of sides that keep the distance `wanted` (m). Points no further from
  /// being hit than `together` (m) are hit as well.
  FreeImpact(const std::array<ImpactSide, 2>& sides, double wanted, double together, double step)
      : sides_(sides),
        wanted_(wanted),
        together_(together),
        step_(step),
        gravity_(sides[0].gravity() - sides[1].gravity()) {}

  /// Finds the time of impact, or that the sides pass each other; neither, if they begin too near
  /// or it takes too long.
  enum class Result { none, hit, pass };
  Result find_time();
  /// Fills the points of the impact and their impulses, and then those of floors, which no side
  /// approaches. False if no side approaches any of the former.
  bool find_points(double friction, std::vector<SweptImpulse>& impulses,
                   std::vector<ImpactPoint>& points);
  /// Finds how the step ends, and the work, from impulses that are solved for.
  void finish(std::span<const ImpactPoint> points);

  const std::array<ImpactSide, 2>& sides() const { return sides_; }
  const RigidState& at_impact(std::size_t side) const { return states_[side]; }
  /// With the velocity that it has without gravity and drag.
  const RigidState& at_end(std::size_t side) const { return ends_[side]; }
  double time_left() const { return step_ - time_; }  // s
  double work() const { return work_; }               // J
  /// J, of what is moved, by its velocity.
  double driven_work() const { return driven_work_; }
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
  RigidState after_impact(std::size_t i, double time) const;
  double motion_left() const;
  bool overlap_after(double duration) const;
  template <class Visit>
  void for_each_near(const std::array<RigidState, 2>& states, double reach,
                     const Visit& visit) const;
  void add_floor(std::size_t i, std::vector<SweptImpulse>& impulses,
                 std::vector<ImpactPoint>& points);
  SweptSide side(std::size_t i, const Vec3& point);
  Vec3 velocity_of(std::size_t i, const Vec3& point, const RigidState& state) const;
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
  double work_ = 0.0, driven_work_ = 0.0;
};

}  // namespace pneuma::sim

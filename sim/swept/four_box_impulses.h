// Four swept impulses between boxes, or between a box and what nothing moves, that have no box in
// common: they are corrected at once, each in its own lane, and what does not change in iterations
// is computed once.
#pragma once

#include <array>

#include "sim/swept/swept_impulse.h"

namespace pneuma::sim {

/// By how much four boxes have been changed, in lanes.
struct FourMotions {
  Vec3x4 velocity{};          // m/s
  Vec3x4 angular_velocity{};  // rad/s

  static FourMotions of(const std::array<BoxChange*, 4>& boxes);
  void give_back(const std::array<BoxChange*, 4>& boxes) const;
};

class FourBoxImpulses {
 public:
  /// One for each axis: along the normal, and two across it.
  using ByAxis = std::array<Vec4d, 3>;

  /// What one iteration did, in the greatest lane or in all of them.
  struct Change {
    Vec4d squared_velocity{};  // m^2/s^2, the greatest
    Vec4d energy{};            // J, the sum of the corrections, each by its mobility
  };

  /// Refers to the impulses; null where there is none.
  void set(const std::array<SweptImpulse*, 4>& impulses);
  /// Takes over what the impulses aim at, their limits and what they are.
  void begin();
  /// First goes on in the direction, `ratio` times as far as the last time and by the last
  /// correction further: the boxes have got their part of it (ConjugateIterations). Then one
  /// projected Gauss-Seidel correction of each, which changes the motions of both sides.
  void correct(double ratio, FourMotions& first, FourMotions& second, Change& change);
  /// Gives back what they are.
  void end() const;

 private:
  struct Side {
    Vec4d inverse_mass{};          // 1/kg; < 0 of the second side
    std::array<Vec3x4, 3> levers;  // m, by axes; turned round on the second side
    std::array<Vec3x4, 3> turns;   // rad/s, by one N s along each axis

    void set(const std::array<const SweptSide*, 4>& sides, double sign,
             const std::array<Vec3x4, 3>& axes);
    void apply(const Vec3x4& whole, const ByAxis& impulse, FourMotions& motions) const;
  };

  void go_on(double ratio);

  std::array<Vec3x4, 3> axes_{};
  Side first_{};
  Side second_{};
  Vec4d normal_mass_{};                         // kg
  Vec4d min_tangent_mass_{1.0, 1.0, 1.0, 1.0};  // kg
  Vec4d mobility_{};                            // 1/kg
  Vec4d friction_{};
  ByAxis by_normal_{};   // m/s along each axis, by one N s along the normal
  Vec4d parting_{};      // m/s
  Vec4d max_normal_{};   // N s
  Vec4d squeeze_{};      // N s
  ByAxis sliding_{};     // m/s
  ByAxis impulse_{};     // N s
  ByAxis correction_{};  // of the last iteration
  ByAxis direction_{};   // in which they go on
  std::array<SweptImpulse*, 4> impulses_{};
};

}  // namespace pneuma::sim

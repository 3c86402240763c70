// What held boxes in the last step, from which the solver of this one starts (ERRATA row 59).
// Private to sim/step.
#pragma once

#include <span>

#include "sim/step/swept_search.h"

namespace pneuma::sim {

class SweptWarmStart {
 public:
  /// Refers to all of them. `start`: what the step starts from.
  SweptWarmStart(World& world, const MotionStart& start, SweptMemory& memory)
      : world_(world), start_(start), m_(memory) {}

  /// Gives each impulse that held a point of a box at this moment of the last step to the nearest
  /// contact of the same boxes: of a part of a step this `fraction`. The contacts are in the order
  /// of their bodies.
  void apply(Moment moment, double fraction);
  /// Keeps what holds boxes at both moments, once the end is solved for, for the next step; and of
  /// boxes that sleep what held them when they fell asleep.
  void remember(double fraction);

 private:
  /// The impulse of the nearest contact, if there is one.
  SweptImpulse* find(const WarmStartImpulse& kept, Moment moment);
  void remember(std::span<const SweptContact> contacts, std::span<const SweptImpulse> impulses,
                Moment moment, double fraction);
  RigidState state(int box, Moment moment) const;

  World& world_;
  const MotionStart& start_;
  SweptMemory& m_;
  std::size_t first_of_pair_ = 0;  // contact of the pair that was last looked for
};

}  // namespace pneuma::sim

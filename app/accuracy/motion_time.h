// How fast a scene moves, as one time: what the steps that an error needs are counted in.
#pragma once

#include <string>

#include "sim/world/world.h"

namespace pneuma::app {

struct MotionTime {
  double seconds = 0.0;  // infinite when nothing moves
  std::string body;      // the fastest
};

/// The shortest time in which a body moves by its own radius (that of the sphere around its rest
/// shape; half the shortest side of a free box): by the acceleration of its vertices at the start,
/// root mean square, sqrt(R / a), or at the highest speed that anything in the world has or reaches
/// by falling to the ground, R / v. Scenes that differ by units of length and time alone have the
/// same errors at the same fraction of this time. `seconds` is that of the run. Gas that is yet to
/// come and speeds that follow keys are not looked at.
MotionTime motion_time(const sim::World& world, double seconds);

}  // namespace pneuma::app

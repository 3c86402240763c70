// How fast what is moved is, beside soft bodies that it may meet.
#pragma once

#include <optional>
#include <string>

#include "sim/world/world.h"

namespace pneuma::app {

struct FastestMotion {
  std::string body;     // that is moved
  double speed = 0.0;   // m/s, of the point of it that is ever the fastest
  std::string soft;     // body of the least extent
  double extent = 0.0;  // m, of that

  /// With which what is moved goes no further in a step than a tenth of the soft body's extent, but
  /// 2,000 at most. In longer steps a soft body that is hit flies off too slowly, and may cross
  /// itself. Rigid bodies, and free ones that fly, do not need it (tests/benchmarks/README.md).
  double steps_per_second() const;
};

/// Of a world as it starts, over `duration` (s); none without moved or without soft bodies.
std::optional<FastestMotion> fastest_motion(const sim::World& world, double duration);

}  // namespace pneuma::app

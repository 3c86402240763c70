// A motion as states at common times, which is what errors are measured between.
#pragma once

#include <vector>

#include "sim/soft/integrators.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// Every step that is studied divides the time between two samples: 1/15 s, the longest of them.
inline constexpr int samples_per_second = 15;

/// Sample i is taken at this time, s; there is none at time 0.
inline double sample_time(std::size_t i) { return static_cast<double>(i + 1) / samples_per_second; }

/// All bodies of a world at one moment.
struct Sample {
  std::vector<sim::SoftState> soft;
  std::vector<sim::RigidBox> rigid;
};

using Trajectory = std::vector<Sample>;

Sample take_sample(const sim::World& world);

}  // namespace pneuma::app

// How much there is to simulate.
#pragma once

#include <cstdint>

#include "sim/world/world.h"

namespace pneuma::app {

struct WorldSize {
  std::int64_t soft_bodies = 0;
  std::int64_t rigid_boxes = 0;
  std::int64_t obstacles = 0;  // that are no boxes
  std::int64_t meshes = 0;     // different ones; bodies of one shape share theirs
  std::int64_t vertices = 0;
  std::int64_t springs = 0;
  std::int64_t triangles = 0;
  std::int64_t state_bytes = 0;  // positions, velocities, orientations: what a step changes
};
WorldSize world_size(const sim::World& world);

}  // namespace pneuma::app

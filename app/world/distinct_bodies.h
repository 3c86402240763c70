// Bodies of which what holds for one holds for its copies.
#pragma once

#include <string>
#include <vector>

#include "sim/world/world.h"

namespace pneuma::app {

struct DistinctBody {
  const sim::SoftBody* first;  // of a mesh and material
  int count = 1;               // of bodies with them
};

/// But for obstacles, one soft body for each mesh and material: only those can differ before the
/// first step.
std::vector<DistinctBody> distinct_bodies(const sim::World& world);

/// "body 'ball'", "body 'ball.1' and 4 like it".
std::string body_and_alike(const std::string& name, int count);

}  // namespace pneuma::app

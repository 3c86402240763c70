// Bodies of which what holds for one holds for its copies.
#pragma once

#include <vector>

#include "sim/world/world.h"

namespace pneuma::app {

/// The first soft body of each mesh and material: only those can differ before the first step.
std::vector<const sim::SoftBody*> distinct_bodies(const sim::World& world);

}  // namespace pneuma::app

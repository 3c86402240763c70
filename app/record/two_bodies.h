// Pairs of bodies by name.
#pragma once

#include <string>

#include "sim/world/world.h"

namespace pneuma::app {

/// "torus and cube.3"; of a body with itself its name alone. Indices as in sim::closed_surfaces(),
/// or sim::ground_body.
std::string two_bodies(const sim::World& world, int first, int second);

}  // namespace pneuma::app

// What volume a soft body's gas blows it up to.
#pragma once

#include <optional>

#include "sim/world/world.h"

namespace pneuma::app {

/// m^3 of the body at rest, alone and without weight: where springs and gas balance each other. By
/// implicit steps so long that they hardly do anything but minimise the energy; the gas pushes
/// evenly (uniform). Infinite when gas meets no springs; none when no balance is found.
std::optional<double> settled_volume(const sim::SoftBody& body);

}  // namespace pneuma::app

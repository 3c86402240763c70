// What volume a soft body's gas blows it up to.
#pragma once

#include <optional>

#include "sim/world/world.h"

namespace pneuma::app {

/// The body where it comes to rest alone and without weight, its gas pushing evenly; none when no
/// balance is found.
std::optional<sim::SoftBody> settled_body(const sim::SoftBody& body);

/// m^3 of the body at rest, alone and without weight: where springs and gas balance each other. By
/// implicit steps so long that they hardly do anything but minimise the energy, of a body of many
/// vertices by explicit ones that are damped; the gas pushes evenly (uniform). Infinite when gas
/// meets no springs; none when no balance is found.
std::optional<double> settled_volume(const sim::SoftBody& body);

/// Pa above those outside with which the body is at rest at that volume in m^3, alone and without
/// weight. The volume is no less than that of the springs at rest: in a smaller one they crumple,
/// this way or that. None when no balance is found.
std::optional<double> held_pressure(const sim::SoftBody& body, double volume);

}  // namespace pneuma::app

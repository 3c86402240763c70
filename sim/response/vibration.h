// The motion of a soft body that is not that of a rigid one: from there energy can be taken without
// a change of momentum or angular momentum.
#pragma once

#include "sim/world/soft_body.h"

namespace pneuma::sim {

/// J.
double energy_of_vibration(const SoftBody& body);

/// Multiplies its velocities by a factor. Of a body `on_ground` that bears it the ground keeps what
/// stands, with a velocity of zero, where it is, and takes the momentum. Returns what was taken, J:
/// less than 0 if that has left more.
double slow_vibration(SoftBody& body, double factor, bool on_ground);

/// Takes so much energy (J) from it, or all that there is; nothing if `energy` is not above 0.
/// Returns what was taken.
double take_from_vibration(SoftBody& body, double energy);

}  // namespace pneuma::sim

// The longest step with which bodies that springs join stay stable, predicted from small motions.
#pragma once

#include "sim/soft/stability_limit.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// The fastest motion that the springs on a soft body could have by themselves, at most; zero, if
/// there are none. One spring moves the middles of its ends by omega^2 = k (1 / m1 + 1 / m2), m1
/// and m2 being what it moves there; springs on common vertices by no more than the sum of theirs,
/// and others by no more than the fastest of them.
Oscillation spring_oscillation(const World& world, int soft_body);

/// As settled_stability_limit, of a body with the springs on it: no motion is faster than its own
/// fastest and the springs' together. Implicit integrators step springs explicitly
/// (joined_step.h), as symplectic_euler does, and so have a limit too.
StabilityLimit joined_stability_limit(Integrator integrator, const World& world, int soft_body);

}  // namespace pneuma::sim

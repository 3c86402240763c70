// A step in which nothing passes through a soft body (ERRATA row 67). Private to sim/step.
//
// Contacts act twice. At the start of the step impulses change the velocities so that the free
// motion that follows, whatever the integrator, leaves every pair of features apart. At its end
// impulses change the velocities so that what touches does not approach. It is the scheme by which
// RATTLE (Andersen 1983) keeps equations between positions and velocities, here for inequalities:
// what contacts do is the work of impulses, and these act along lines between bodies, so that
// momentum is kept. Only boxes too near each other are also shifted (shift_boxes.h), and
// boxes that meet nothing else but a floor are hit at the moment at which they meet
// (impacts/free_impacts.h).
//
// The first impulses are computed for features that move along straight lines. Whether surfaces
// meet on their ways is then looked at (time_of_meeting); if they do, the impulses are computed
// once more with what was found, up to four times, and if that does not help, the step is halved.
// Once more also for boxes that they have turned away from what stopped these.
#pragma once

#include <optional>

#include "sim/step/stepper.h"

namespace pneuma::sim {

struct StepWorkspace;

/// Steps the world once. What diverges, and bodies that no halving keeps apart, end it: the world
/// is then as the step found it.
std::optional<Divergence> swept_step(World& world, StepWorkspace& workspace);

}  // namespace pneuma::sim

// A vertex of a soft body that meets the ground and nothing else: what the corrections of
// ContactImpulse come to, in closed form (ERRATA row 31).
#pragma once

#include <optional>

#include "sim/world/world.h"

namespace pneuma::sim {

/// How a vertex that was above z = 0 when the step began has come below it.
struct GroundImpact {
  double fraction = 0.0;  // of the step, after which it met the ground
  double speed = 0.0;     // m/s, downwards, as it did
};

/// With velocities that change evenly over the step. Of a vertex that was not above the ground the
/// impact is at the start. Heights in m, velocities along z in m/s.
GroundImpact ground_impact(double start_height, double start_velocity, double height,
                           double velocity);

/// A vertex that has come below z = 0 bounces there: from then on it moves as the rest of the step
/// would have moved it, so that with a restitution of 1 the ground takes no energy to second order
/// in the step (ERRATA row 70). Friction as in meet_ground. Returns the height (m) that it gets
/// to; none, and nothing is changed, if it is too slow to bounce, or turns round in this step.
std::optional<double> bounce(const GroundImpact& impact, const ContactMaterial& pair, double step,
                             Vec3& velocity);

/// Stops the velocity (m/s) of a vertex that falls onto z = 0, or lets it bounce with the
/// restitution times `start_approach` (m/s, how fast it fell at the start of the step);
/// friction takes at most mu times what the normal impulse changes (paper 3.1.4, ERRATA row 6).
/// `pair`: of body and ground. Returns whether friction is below that limit, so that it holds the
/// vertex.
bool meet_ground(double start_approach, const ContactMaterial& pair, Vec3& velocity);

}  // namespace pneuma::sim

// A vertex of a soft body that meets the ground and nothing else: what the corrections of
// ContactImpulse come to, in closed form (ERRATA row 31).
#pragma once

#include "sim/world/world.h"

namespace pneuma::sim {

/// Stops the velocity (m/s) of a vertex that falls onto z = 0, or lets it bounce with the
/// restitution times `start_approach` (m/s, how fast it fell at the start of the step);
/// friction takes at most mu times what the normal impulse changes (paper 3.1.4, ERRATA row 6).
/// `pair`: of body and ground. Returns whether friction is below that limit, so that it holds the
/// vertex.
bool meet_ground(double start_approach, const ContactMaterial& pair, Vec3& velocity);

}  // namespace pneuma::sim

// Whether a step ended in a sound state. Looked for in every step: on the paper's sphere by rk4 it
// costs 13 % of the step's 3.9 us, of which the volume 7 % and all else 6 %.
#pragma once

#include <optional>

#include "sim/soft/soft_state.h"
#include "sim/step/stepper.h"

namespace pneuma::sim {

/// m/s, of a vertex. Neither springs nor gas mean anything at a third of the speed of light.
inline constexpr double greatest_speed = 1e8;

/// What the energy of motion and springs may become by a step of an explicit integrator, in units
/// of what it was and what gas and gravity have added. Even so close to its limit that the energy
/// of the fastest motion swings by a factor of 100, 2 % below, a step is not taken for unsound.
inline constexpr double greatest_gain = 100.0;

/// By which a volume may grow from the least at which a step of an explicit integrator took its
/// force to its end. That force does not last: the gas would do far more work than it has to give.
inline constexpr double greatest_growth = 64.0;

/// After integrate_soft. `start`: as the step found the body; `least_volume`: as the integrator
/// reports it.
std::optional<Divergence> find_divergence(const World& world, const SoftBody& body,
                                          const SoftState& start, double least_volume);

/// After resolve_contacts.
std::optional<Divergence> find_divergence(const World& world, const SoftBody& body);
std::optional<Divergence> find_divergence(const World& world, const RigidBox& box);

}  // namespace pneuma::sim

// Whether a step ended in a valid state (ERRATA row 65). Looked for in every step; what that costs
// is in tests/benchmarks/README.md.
#pragma once

#include <optional>
#include <vector>

#include "sim/base/workers.h"
#include "sim/soft/soft_state.h"
#include "sim/step/stages/divergence.h"

namespace pneuma::sim {

/// m/s, of a vertex. Neither springs nor gas mean anything at a third of the speed of light.
inline constexpr double max_speed = 1e8;

/// What the kinetic and spring energy may become by a step of an explicit integrator, in units of
/// what it was and what gas and gravity have added. A valid step may be so close to the stability
/// limit (2 % below) that the energy of the fastest mode swings by a factor of 100.
inline constexpr double max_gain = 100.0;

/// Factor by which a volume may grow to the end of a step of an explicit integrator, from the
/// smallest one at which the step evaluated its force. That force does not last: the gas would do
/// far more work than it has to give.
inline constexpr double max_growth = 64.0;

/// After integrate_soft. `start`: as the step found the body; `min_volume`: as the integrator
/// reports it. Needs memory where the body has gained energy from nothing, as it may in steps near
/// the longest stable one.
std::optional<Divergence> find_divergence(const World& world, const SoftBody& body,
                                          const SoftState& start, double min_volume);

/// The same of a body on which springs to others do work, whose energy is not looked at.
std::optional<Divergence> find_divergence_of_joined(const World& world, const SoftBody& body,
                                                    const SoftState& start, double min_volume);

/// After resolve_contacts.
std::optional<Divergence> find_divergence(const World& world, const SoftBody& body);
std::optional<Divergence> find_divergence(const World& world, const RigidBox& box);
/// The first of all bodies. `outcomes`: memory.
std::optional<Divergence> find_first_divergence(const World& world,
                                                std::vector<std::optional<Divergence>>& outcomes,
                                                base::Workers& workers);

}  // namespace pneuma::sim

// Trying a step: does a body at rest, given a little motion, keep it little?
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/world/world.h"

namespace pneuma::app {

enum class Verdict {
  stable,
  diverged,  // not finite, too fast, or with energy from nowhere
  inverted,  // a volume at or below zero
};
std::string to_string(Verdict verdict);

struct TrialOptions {
  double seconds = 60.0;
  /// Of steps so short that there are more. A motion that is a thousandth beyond its limit grows by
  /// a factor e in a hundred steps or so.
  std::int64_t most_steps = 20'000;
};

struct Trial {
  int steps_per_second = 60;
  Verdict verdict = Verdict::stable;
  std::string reason = {};  // when it is not stable
};

inline constexpr double start_speed = 0.01;  // m/s
/// Lets every vertex move with up to start_speed along each axis, so that every small motion is in
/// it.
void disturb(sim::SoftBody& body);

/// A free body at rest under its own springs and gas, disturbed.
sim::World body_at_rest(const sim::Settings& settings, sim::SoftBody body);

/// Runs a copy of a body at rest with this step. It is stable when no step fails and its energy has
/// not risen by more than a hundred times what it moved with at the start.
Trial try_step(const sim::World& at_rest, sim::Integrator integrator, int steps_per_second,
               const TrialOptions& options);

inline constexpr int fewest_steps_per_second = 15;
inline constexpr int most_steps_per_second = 1 << 20;

/// The fewest steps per second that are stable, to 2 %, by bisection; nothing when none up to
/// most_steps_per_second are. Every trial made on the way goes into `trials`.
std::optional<int> find_stable_rate(const sim::World& at_rest, sim::Integrator integrator,
                                    const TrialOptions& options, std::vector<Trial>& trials);

}  // namespace pneuma::app

// Runs an impact and looks at every step of it.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "app/study/impact/random_impact.h"

namespace pneuma::app {

enum class ImpactOutcome {
  missed,     // the bodies did not meet
  held,       // to the end, and the bodies never crossed
  stopped,    // by the program, which says why
  crossed,    // each other: at the end of a step, or on the way there
  no_volume,  // is left of a body
  refused,    // before the first step
};
inline constexpr auto impact_outcomes = std::to_array<std::string_view>(
    {"missed", "held", "stopped", "crossed", "no volume", "refused"});

struct ImpactResult {
  ImpactOutcome outcome = ImpactOutcome::missed;
  std::string message;       // of what did not hold
  int steps_per_second = 0;  // as it came to its end: the scene's, or doubled until springs bore it
  double seconds = 0.0;      // of the scene's time, done
  double most_work = 0.0;    // of contacts in one step, of the kinetic energy at the start
};

ImpactResult run_impact(const RandomImpact& impact);

}  // namespace pneuma::app

// Runs extreme cases and says what they came to.
#pragma once

#include <array>
#include <string>
#include <utility>

#include "app/study/extreme/extreme_cases.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// What the cases are run with, and whether it is implicit.
inline constexpr std::array<std::pair<const char*, bool>, 3> extreme_integrators = {
    {{"rk4", false}, {"implicit_euler", true}, {"sdirk2", true}}};

struct ExtremeResult {
  Outcome outcome = Outcome::valid;
  bool valid = true;                // of a run that went to its end: whether it was
  std::string message;              // why it was refused, diverged or is not valid
  double seconds = 0.0;             // of the scene's time, done
  double energy_gain = 0.0;         // J above the start at most, of the span below
  double energy_span = 0.0;         // J between min. and max.
  double least_volume_share = 1.0;  // of its first, over all bodies with gas and the whole run
  double penetration = 0.0;         // m, max. in the last half
  double greatest_speed = 0.0;      // m/s, of any vertex or box
};

ExtremeResult run_extreme(const ExtremeCase& extreme, const std::string& integrator);

/// Whether it is what was expected.
bool as_expected(const ExtremeCase& extreme, bool implicit, const ExtremeResult& result);

/// "valid", "refused", "diverged"; of several "valid or diverged".
std::string to_string(Outcome outcome);
std::string to_string(const std::vector<Outcome>& outcomes);

}  // namespace pneuma::app

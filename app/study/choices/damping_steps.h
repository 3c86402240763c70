// What the two readings of the paper's damping do at different steps (ERRATA row 5).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/world/world.h"

namespace pneuma::app {

/// One body at one step, with rk4.
struct DampingRun {
  sim::Damping damping = sim::Damping::dashpot;
  int steps_per_second = 60;
  /// m/s: that of the centre after falling from rest; nothing when the run diverged.
  std::optional<double> fall_speed;
  /// Of a free body that swings without gravity: the max. kinetic energy in the second half of
  /// the time over that in the first half; nothing when the run diverged or nothing swings.
  std::optional<double> swing_left;
};

struct DampingStudy {
  double seconds = 0.0;
  double exact_fall_speed = 0.0;  // m/s, of the differential equation: g (1 - e^(-gamma t)) / gamma
  std::vector<DampingRun> runs;   // dashpot, then literal, each from long to short steps
};

/// Rates are multiples of 15, ascending. Throws Interrupted.
DampingStudy study_damping(const sim::SoftBody& body, const std::vector<int>& steps_per_second,
                           double seconds);

/// What the runs of each damping say, from the longest to the shortest step; one each.
std::vector<std::string> damping_sentences(const DampingStudy& study);

}  // namespace pneuma::app

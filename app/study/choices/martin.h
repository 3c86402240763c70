// The paper's integrator beside the others (ERRATA row 7), out of an error study.
#pragma once

#include <string>
#include <vector>

#include "app/study/error/error_study.h"

namespace pneuma::app {

/// `martin` beside one other integrator at one step that is stable for both.
struct MartinComparison {
  std::string other;
  int steps_per_second = 60;
  double error_ratio = 0.0;  // martin's over the other's
  double time_ratio = 0.0;   // likewise
};

/// At every step at which both are stable, in the order of the study's runs.
std::vector<MartinComparison> compare_martin(const ErrorStudy& study);

/// At 1/60 s, or the first step after it that is stable for both, against each other integrator;
/// and what an error of 1e-2 takes.
std::vector<std::string> martin_sentences(const ErrorStudy& study);

}  // namespace pneuma::app

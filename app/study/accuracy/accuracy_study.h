// `pneuma study accuracy`: what --accuracy chooses for a scene, what it reaches and what it costs.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/study/error/error_study.h"

namespace pneuma::app {

struct AccuracyOptions {
  double seconds = 1.2;                // simulated, at most as long as the scene
  int finest_steps_per_second = 7680;  // of what errors are measured against, in part (reference.h)
  int repeats = 5;                     // of each run, for its time
};

struct AccuracyRow {
  std::string asked_for;   // "1e-2"; empty for the integrator and step of the scene itself
  double max_error = 0.0;  // of what was asked for
  ErrorRun run;

  bool is_reached() const {
    return run.status == ErrorRun::Status::stable && error_of(run) <= max_error;
  }
};

struct AccuracyStudy {
  std::string name;
  double seconds = 0.0;           // compared
  double uncertainty = 0.0;       // how well the motion is known
  int max_contacts = 0;           // of a step in the compared time
  std::vector<AccuracyRow> rows;  // the scene's own first
};

/// How many contacts there were: an error without any says little about one with some.
std::string contacts_text(const AccuracyStudy& study);

/// Throws what study_errors and choose_step do.
AccuracyStudy study_accuracy(const std::string& name, const std::vector<std::string>& overrides,
                             const AccuracyOptions& options,
                             const std::function<void(const std::string&)>& say);

}  // namespace pneuma::app

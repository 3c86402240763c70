// What `pneuma study choices` prints and writes.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/study/choices/damping_steps.h"
#include "app/study/choices/drift.h"
#include "app/study/diagram.h"
#include "app/study/error/error_study.h"

namespace pneuma::app {

/// Both forms of ERRATA rows 4, 5 and 7, measured on one body.
struct ChoicesStudy {
  std::string name;  // of the scene, with the body when there is only one of several
  std::string title;
  DriftStudy drift;
  DampingStudy damping;
  ErrorStudy integrators;  // in free flight, without CVODE
};

std::string choices_text(const ChoicesStudy& study);
nlohmann::json choices_json(const ChoicesStudy& study);

/// A row per trial and sample.
std::string drift_csv(const ChoicesStudy& study);
/// A row per damping and step.
std::string damping_csv(const ChoicesStudy& study);
/// A row per other integrator and step.
std::string martin_csv(const ChoicesStudy& study);

/// Distance over time of each trial, for both weightings.
Diagram drift_diagram(const ChoicesStudy& study);
/// Fall speed over step, for both dampings.
Diagram damping_diagram(const ChoicesStudy& study);

}  // namespace pneuma::app

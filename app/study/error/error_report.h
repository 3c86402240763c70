// What `pneuma study error` prints and writes.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/study/diagram.h"
#include "app/study/error/error_study.h"

namespace pneuma::app {

/// Tables of at most 120 columns, orders, recommendations, comparison with SUNDIALS.
std::string error_text(const ErrorStudy& study);

/// All figures. Times in seconds; what was not measured is null.
nlohmann::json error_json(const ErrorStudy& study);

/// A row per run.
std::string runs_csv(const ErrorStudy& study);

/// A row per error of `compared_errors`: the cheapest of ours and of SUNDIALS, and their ratio.
std::string ratios_csv(const ErrorStudy& study);

/// Error over run time. Unstable runs stand along the top edge, a row for each method.
Diagram work_diagram(const ErrorStudy& study);

/// Error over step, likewise.
Diagram step_diagram(const ErrorStudy& study);

}  // namespace pneuma::app

// What `pneuma study stability` leaves: text for people, CSV and JSON for programs, maps.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/study/diagram.h"
#include "app/study/stability/stability_study.h"

namespace pneuma::app {

std::string stability_text(const StabilityStudy& study);

/// A row per integrator and value: the longest stable step found and the one predicted.
std::string limits_csv(const StabilityStudy& study);

/// A row per trial, and per cell of the map: step, verdict, reason.
std::string trials_csv(const StabilityStudy& study);

nlohmann::json stability_json(const StabilityStudy& study);

/// Step against stiffness of one integrator: the cells with their verdicts, and the limits.
Diagram stability_map(const StabilityStudy& study, sim::Integrator integrator);

}  // namespace pneuma::app

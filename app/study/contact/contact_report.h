// What a contact study leaves behind.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "app/study/contact/contact_study.h"
#include "app/study/diagram.h"

namespace pneuma::app {

/// The limit, the cheapest runs of each form of contact, and which to take.
std::string contact_text(const ContactStudy& study);

/// Which contact and integrator to take, a row for each scene.
std::string advice_text(std::span<const ContactStudy> studies);

/// A row per run.
std::string contact_csv(const ContactStudy& study);

/// All figures. Times in seconds; what was not measured is null.
nlohmann::json contact_json(const ContactStudy& study);

/// Error over run time: of each form the cheapest runs.
Diagram contact_diagram(const ContactStudy& study);

}  // namespace pneuma::app

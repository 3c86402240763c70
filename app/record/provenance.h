// Where, when and by what something was measured: what every report says of itself.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace pneuma::app {

/// Now, ISO 8601, UTC.
std::string utc_date();

/// {"machine": {...}, "program": {...}}.
nlohmann::json provenance_json();

/// "Machine: ...\nProgram: ... `date`.\n".
std::string provenance_text(const std::string& date);

}  // namespace pneuma::app

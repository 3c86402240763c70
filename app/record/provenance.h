// Where, when and by what something was measured: what every report says of itself.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "app/host/machine.h"
#include "app/host/version.h"

namespace pneuma::app {

/// The machine that runs this.
template <class Json = nlohmann::json>
Json machine_json() {
  const Machine here = machine();
  return {{"cpu", here.cpu}, {"cores", here.cores}, {"os", here.os}};
}

/// How this program was built.
template <class Json = nlohmann::json>
Json program_json() {
  const Version built = version();
  return {{"version", built.program},
          {"commit", built.commit},
          {"compiler", built.compiler},
          {"build_type", built.build_type},
          {"flags", built.flags}};
}

/// Now, ISO 8601, UTC.
std::string utc_date();

/// {"machine": {...}, "program": {...}}.
nlohmann::json provenance_json();

/// "Machine: ...\nProgram: ... `date`.\n".
std::string provenance_text(const std::string& date);

}  // namespace pneuma::app

// What can be measured of a run: the values of `pneuma check --run --json`, by name.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "app/check/run_statistics.h"

namespace pneuma::app {

/// A column of a sweep's table.
struct Measure {
  std::string name;
  std::string path;  // in the JSON of a run: "/energy_J/end/total"
};

/// By a short name ("penetration") or a path of the JSON with dots ("energy_J.end.total",
/// "volumes_m3.0.least"). An empty path: there is none of that name.
Measure find_measure(const std::string& name);

/// All names, the short ones first.
std::vector<std::string> measure_names();

/// Those of a sweep that names none.
std::vector<Measure> default_measures();

/// "J", as the names on its path end in; empty for what has none.
std::string_view unit_of(const Measure& measure);

/// Whether it says how far a run came, which means something also where it diverged.
bool is_of_length(const Measure& measure);

/// The measured value; null where the run has none. `run` is run_statistics_json's.
nlohmann::ordered_json measured(const Measure& measure, const nlohmann::json& run);

}  // namespace pneuma::app

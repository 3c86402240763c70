// What `pneuma bench` prints.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/bench/measure_scene.h"

namespace pneuma::app {

struct BenchReport {
  MeasureOptions options;
  std::vector<SceneTimes> scenes;
  std::vector<std::string> warnings;
  std::string date;  // ISO 8601, UTC
};

/// Tables of at most 120 columns, their legend and foot notes.
std::string bench_text(const BenchReport& report);

/// The same for machines. Times in seconds; what was not measured is null.
nlohmann::json bench_json(const BenchReport& report);

/// A sentence for each scene whose times are doubtful because of how its own measurement went.
std::vector<std::string> measurement_warnings(const std::vector<SceneTimes>& scenes);

}  // namespace pneuma::app

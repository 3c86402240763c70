// What `pneuma check` prints.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/check/run_statistics.h"
#include "app/world/gas_advice.h"
#include "app/world/step_advice.h"
#include "app/world/world_size.h"
#include "scenes/loader/scene.h"
#include "sim/step/stages/plan.h"

namespace pneuma::app {

struct CheckReport {
  scenes::Scene scene;
  sim::Plan plan;
  WorldSize size;
  std::vector<StepAdvice> steps;
  std::vector<GasAdvice> gas;
  std::optional<RunStatistics> run;
};

/// A summary as comments, the effective scene, and the run as comments again, so that the whole is
/// a scene file again.
std::string check_text(const CheckReport& report);
nlohmann::json check_json(const CheckReport& report);

/// Of check_json the scene's name and the run.
nlohmann::json run_json(const CheckReport& report);

/// "torus and cube: overlap from the start, parted by t = 0.40 s".
std::string start_overlap_text(const StartOverlapStatistics& start);

/// The lines about a run alone.
std::string run_statistics_text(const RunStatistics& run, const sim::Settings& settings);
nlohmann::json run_statistics_json(const RunStatistics& run);

}  // namespace pneuma::app

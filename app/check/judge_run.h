// Whether a run kept its bodies apart.
#pragma once

#include <string>

#include "app/check/run_statistics.h"
#include "app/host/exit_code.h"
#include "scenes/loader/scene.h"

namespace pneuma::app {

struct RunVerdict {
  ExitCode code = ExitCode::done;  // or check_failed
  std::string words;               // lines about what passed through what; empty: nothing to say
};

/// check_failed when bodies passed through each other, deeper than a touch, or still lie in each
/// other as they started; how far at most, and what helps. Of a run that did not diverge.
RunVerdict judge_run(const scenes::Scene& scene, const RunStatistics& run);

}  // namespace pneuma::app

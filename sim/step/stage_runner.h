// Runs the stages of a step that the plan has, and takes their times. Private to sim/step.
#pragma once

#include <chrono>

#include "sim/step/workspace.h"

namespace pneuma::sim {

/// Runs one stage if the plan has it, and takes its time if asked to.
class StageRunner {
 public:
  explicit StageRunner(StepWorkspace& workspace) : workspace_(workspace) {}

  template <class Work>
  void operator()(Stage stage, const Work& work) const {
    if (!workspace_.plan.runs(stage)) return;
    if (!workspace_.options.profile) return work();
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    workspace_.stage_times[static_cast<std::size_t>(stage)] += taken.count();
  }

 private:
  StepWorkspace& workspace_;
};

}  // namespace pneuma::sim

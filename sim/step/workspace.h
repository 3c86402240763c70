// The memory that the stages of a step share: scratch and this step's contacts. Private to
// sim/step.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sim/soft/integrators.h"
#include "sim/step/stepper.h"
#include "sim/step/workers.h"

namespace pneuma::sim {

/// What integrate_soft needs per thread: one scratch per distinct mesh, shared by all bodies of it.
struct SoftScratch {
  std::vector<std::vector<IntegratorScratch>> per_thread;  // [thread][mesh]
  std::vector<int> mesh_of_body;
};

struct StepWorkspace {
  StepWorkspace(const World& world, StepperOptions options);

  StepperOptions options;
  Plan plan;
  Workers workers;
  SoftScratch soft;
  std::vector<SoftState> soft_start;                    // per body, as the step found it
  std::vector<std::optional<Divergence>> soft_outcome;  // per body
  std::vector<Contact> contacts;
  StageTimes stage_times{};
};

}  // namespace pneuma::sim

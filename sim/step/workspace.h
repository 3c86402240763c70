// All memory of a stepper. Only the stepper sees it whole; it hands each stage its part
// (stages.h). Private to sim/step.
#pragma once

#include <memory>
#include <optional>

#include "sim/base/workers.h"
#include "sim/joints/gas_flow.h"
#include "sim/step/potential_step.h"
#include "sim/step/stages/stage_memory.h"
#include "sim/step/swept/swept_search.h"

namespace pneuma::sim {

struct StepWorkspace {
  StepWorkspace(const World& world, StepperOptions options);

  StepperOptions options;
  Plan plan;
  base::Workers workers;
  bool has_given_motions;
  bool has_inputs;  // these, or gas that comes and goes
  bool has_pins;
  StageTimes stage_times{};

  std::optional<GasFlow> gas_flow;  // if gas comes or goes
  MotionStart motion_start;
  PairStart pair_start;
  NearBodies near_bodies;
  std::vector<Contact> contacts;
  double contact_work = 0.0;  // J, if it is measured

  IntegrateSoftMemory integrate_soft;
  BroadPhaseMemory broad_phase;
  MoveParticlesMemory move_particles;
  FindContactsMemory find_contacts;
  ResolveContactsMemory resolve_contacts;
  DepenetrateMemory depenetrate;
  std::optional<SweptMemory> swept;            // if the world has swept contacts
  std::optional<FallAsleep> fall_asleep;       // of a soft body that can touch the ground alone
  std::unique_ptr<PotentialMemory> potential;  // if contact is a potential
};

}  // namespace pneuma::sim

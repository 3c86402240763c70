// A world that advances from frame to frame.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "app/host/errors.h"
#include "scenes/loader/scene.h"
#include "sim/step/stepper.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// Names the scene, step, time, stage and body, what is near it, what happened, its likely cause
/// and what to do. `world`: in its last valid state. `tried_parts` of the step diverged too.
DivergenceError divergence_error(const std::string& scene_name, const sim::Divergence& divergence,
                                 const sim::World& world, bool tried_parts = false);

/// What to do about a step that diverges.
enum class OnDivergence {
  automatic,  // substep, where the step is short enough for small motions; stop, where it is not
  stop,
  substep,  // do it again in 2, 4, ... parts, up to greatest_step_parts
};
inline constexpr int greatest_step_parts = 1024;

/// What another simulation of the same run has come to.
struct SimulatedFrame {
  sim::World world;
  std::vector<sim::Contact> contacts;  // these and what follows: see Simulation
  std::vector<int> step_parts;
  sim::StageTimes stage_times{};
  double driven_work = 0.0;
  double gas_work = 0.0;
};

class Simulation {
 public:
  Simulation(const scenes::Scene& scene, sim::World world, int threads,
             OnDivergence on_divergence = OnDivergence::automatic);

  /// The steps to the next picture. Throws DivergenceError, also for a body that is beyond all
  /// reason away; the world is then in its last valid state.
  void advance_frame();
  /// One of these steps; step_parts() is then of it alone. Throws likewise.
  void advance_step();

  SimulatedFrame present_frame() const;
  /// In place of advance_frame(), from any frame before.
  void adopt(SimulatedFrame frame);

  const scenes::Scene& scene() const { return scene_; }
  const sim::World& world() const { return world_; }
  const sim::Stepper& stepper() const { return stepper_; }
  /// Of the last step, or of the last of its parts: see Stepper.
  std::span<const sim::Contact> contacts() const {
    return has_other_contacts_ ? std::span<const sim::Contact>(other_contacts_)
                               : stepper_.contacts();
  }
  /// J, of the last step: see Stepper.
  double driven_work() const { return driven_work_; }
  double gas_work() const { return gas_work_; }
  /// Of the steps to the present frame that were done in parts: in how many.
  const std::vector<int>& step_parts() const { return step_parts_; }
  /// s, of each stage in the steps to the present frame, with those that were taken back.
  const sim::StageTimes& stage_times() const { return stage_times_; }
  /// The frame that shows the present state; frame 0 is the start.
  std::int64_t frame() const { return world_.steps / steps_per_frame_; }

 private:
  void step();
  bool divides() const;
  bool step_in_parts(int parts);
  void require_all_near() const;
  void require_near(const std::string& body, double distance) const;

  scenes::Scene scene_;
  int threads_;
  OnDivergence on_divergence_;
  int steps_per_frame_;
  sim::World world_;
  sim::Stepper stepper_;
  std::vector<int> step_parts_;
  sim::StageTimes stage_times_{};
  sim::StageTimes times_of_parts_{};  // s, of all steps that were tried in parts
  std::vector<sim::Contact> other_contacts_;
  bool has_other_contacts_ = false;  // the stepper has not made the last step
  double driven_work_ = 0.0;
  double gas_work_ = 0.0;
};

}  // namespace pneuma::app

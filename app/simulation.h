// A world that advances from frame to frame.
#pragma once

#include <cstdint>
#include <string>

#include "app/errors.h"
#include "scenes/scene.h"
#include "sim/step/stepper.h"
#include "sim/world.h"

namespace pneuma::app {

/// Names the scene, the step, the time, the body and what happened.
DivergenceError divergence_error(const std::string& scene_name, const sim::Divergence& divergence,
                                 const sim::Settings& settings);

class Simulation {
 public:
  Simulation(const scenes::Scene& scene, sim::World world, int threads);

  /// The steps from one picture to the next. Throws DivergenceError, also for a body that is beyond
  /// all reason away.
  void advance_frame();

  const sim::World& world() const { return world_; }
  const sim::Stepper& stepper() const { return stepper_; }
  /// The frame that shows the present state; frame 0 is the start.
  std::int64_t frame() const { return world_.steps / steps_per_frame_; }

 private:
  void require_near(const std::string& body, double distance) const;

  std::string scene_name_;
  int steps_per_frame_;
  sim::World world_;
  sim::Stepper stepper_;
};

}  // namespace pneuma::app

// A part of a scene's run, stepped through over and over.
#pragma once

#include <cstdint>
#include <string>

#include "sim/step/stepper.h"
#include "sim/world/world.h"

namespace pneuma::app {

class Replay {
 public:
  /// From `start`, for `length` steps (at least 1), then from `start` again. Errors name the scene.
  Replay(std::string scene_name, sim::World start, std::int64_t length,
         sim::StepperOptions options);

  void restart() { world_ = start_; }

  /// Makes room for `count` steps: goes back to the start when fewer are left, if ever there are so
  /// many. Apart from run() because it is not to be timed.
  void prepare(std::int64_t count);

  /// Throws DivergenceError, and Interrupted. Obstacles may be left behind (sim::StepperOptions).
  void run(std::int64_t count);
  void place_obstacles() { stepper_.place_obstacles(world_); }

  const sim::World& world() const { return world_; }
  const sim::Stepper& stepper() const { return stepper_; }

 private:
  std::string scene_name_;
  sim::World start_;
  sim::World world_;
  sim::Stepper stepper_;
  std::int64_t length_;
};

/// Throws DivergenceError, and Interrupted.
void advance(sim::Stepper& stepper, sim::World& world, std::int64_t steps,
             const std::string& scene_name);

}  // namespace pneuma::app

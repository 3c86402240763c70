#include "app/world/replay.h"

#include <utility>

#include "app/host/interrupt.h"
#include "app/world/simulation.h"

namespace pneuma::app {

void advance(sim::Stepper& stepper, sim::World& world, std::int64_t steps,
             const std::string& scene_name) {
  for (std::int64_t i = 0; i < steps; ++i) {
    throw_if_interrupted();
    const auto divergence = stepper.step(world);
    if (divergence) throw divergence_error(scene_name, *divergence, world);
  }
}

Replay::Replay(std::string scene_name, sim::World start, std::int64_t length,
               sim::StepperOptions options)
    : scene_name_(std::move(scene_name)),
      start_(std::move(start)),
      world_(start_),
      stepper_(start_, std::move(options)),
      length_(length) {}

void Replay::prepare(std::int64_t count) {
  if (world_.steps + count > start_.steps + length_ && world_.steps > start_.steps) restart();
}

void Replay::run(std::int64_t count) { advance(stepper_, world_, count, scene_name_); }

}  // namespace pneuma::app

// The steps that an error needs, measured or estimated from measurements: plain data.
#pragma once

#include <span>

#include "app/accuracy/accuracy.h"
#include "sim/world/settings.h"

namespace pneuma::app {

/// What a scene has that can touch.
enum class Situation {
  free_flight,  // nothing
  one_body,     // one soft body, and what stands still or is moved
  bodies,       // several soft bodies
  boxes,        // free boxes, too
};

/// "several soft bodies", ...
std::string_view to_string(Situation situation);

struct MeasuredStep {
  Situation situation;
  sim::Integrator integrator;
  std::array<double, 3>
      steps;    // for each accuracy, in a motion time (motion_time.h); 0: none known
  double cost;  // of a step, in those of velocity_verlet
};

/// Of swept contacts.
std::span<const MeasuredStep> measured_steps();

}  // namespace pneuma::app

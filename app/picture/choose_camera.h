// place_camera for a command: people see how far it is.
#pragma once

#include "app/picture/place_camera.h"
#include "app/terminal/progress.h"

namespace pneuma::app {

/// Shows the run ahead, and what the user should know. Throws Interrupted.
render::Camera choose_camera(const scenes::Scene& scene, const sim::World& start, int threads,
                             Progress& progress);

}  // namespace pneuma::app

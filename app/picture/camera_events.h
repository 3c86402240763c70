// A RunCamera's events for a command: people see how far it is.
#pragma once

#include "app/picture/run_camera.h"
#include "app/terminal/progress.h"

namespace pneuma::app {

/// Shows the run ahead, and what the user should know. The run ahead throws Interrupted.
CameraEvents camera_events(const scenes::Scene& scene, Progress& progress);

}  // namespace pneuma::app

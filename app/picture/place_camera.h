// Where the camera of a scene stands at the start, unless the scene leaves it to the program:
// run_camera.h.
#pragma once

#include <string>

#include "render/frame/frame.h"
#include "scenes/loader/scene.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// Whether the camera is to show the run, wherever that goes.
bool is_left_to_program(const scenes::CameraScene& camera);

/// Of a scene that gives eye and target or a path, or a body to follow, beside which the camera
/// then is.
render::Camera placed_camera(const scenes::Scene& scene, const sim::World& start);

/// Why the scene's own camera shows nothing of it at the start; empty where it does, and where the
/// scene leaves the camera to the program.
std::string what_camera_misses(const scenes::Scene& scene, const sim::World& start);

}  // namespace pneuma::app

// Where the camera of a run stands.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "render/frame/frame.h"
#include "scenes/loader/scene.h"
#include "sim/mesh/measure.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// Called once per frame of a simulation that is run ahead; may throw to stop it.
using OnFrame = std::function<void(const sim::World& world)>;

struct PlacedCamera {
  render::Camera camera;
  std::string notice;  // what the user should know about it, if anything
};

/// The scene's own camera at the start or, where the scene leaves it to the program, one that has
/// all bodies in view over the whole run, above the caption: for that the run is simulated once
/// ahead. A run that diverges counts up to there. A camera that follows a body shows that body, and
/// nothing is simulated.
PlacedCamera place_camera(const scenes::Scene& scene, const sim::World& start, int threads,
                          const OnFrame& on_frame = {});

/// The nearest camera that has all bodies in view as they are, from every side that `turned`
/// (camera_motion.h) brings it to.
render::Camera camera_around(const scenes::Scene& scene, const sim::World& world);

/// Why the scene's own camera shows nothing of it at the start; empty where it does, and where the
/// scene leaves the camera to the program.
std::string what_camera_misses(const scenes::Scene& scene, const sim::World& start);

/// The part of a run's bounds worth showing: bodies that fall or fly away for ever would make all
/// others vanish. `largest_body` is the max. diagonal of a single body during the run, m.
sim::Bounds useful_bounds(const sim::Bounds& start, const sim::Bounds& run, double largest_body);

}  // namespace pneuma::app

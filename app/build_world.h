// Scene -> World: makes the meshes, the copies and the start state.
#pragma once

#include "scenes/scene.h"
#include "sim/world.h"

namespace pneuma::app {

/// The world at time zero. The same scene gives the same bytes with every compiler and standard
/// library: what is random comes from the scene's seed by arithmetic of our own. Bodies of the same
/// shape share one mesh. Copies of a body are called NAME.1, NAME.2, ...
/// Throws scenes::SceneError for a body that cannot be simulated: one whose mesh is degenerate, or
/// one with gas but without a volume.
sim::World build_world(const scenes::Scene& scene);

}  // namespace pneuma::app

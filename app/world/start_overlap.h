// Bodies that start in each other or in the ground, where swept contacts would keep them.
#pragma once

#include "scenes/loader/scene.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// Throws scenes::SceneError if the scene has swept contacts and a body starts in the ground, or in
/// or through an earlier body, by more than rounding: it names both. Bodies may touch. `start`:
/// what build_world made of the scene.
void refuse_start_overlap(const scenes::Scene& scene, const sim::World& start);

}  // namespace pneuma::app

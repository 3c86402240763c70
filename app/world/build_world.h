// Scene -> World: makes the meshes, the copies and the start state.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/loader/scene.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// The world at time zero. The same scene gives the same bytes with every compiler and standard
/// library: what is random comes from the scene's seed by arithmetic of our own. Bodies of the same
/// shape share one mesh. Copies of a body are called NAME.1, NAME.2, ...
/// Throws scenes::SceneError for a body that cannot be simulated: one whose mesh is degenerate, or
/// one with gas but without a volume, or with models larger than the scene's limits; and what
/// load_model_mesh throws.
sim::World build_world(const scenes::Scene& scene);

/// A number for each body of the scene whose shape is a model, from its mesh: equal meshes, equal
/// numbers. `world` as build_world made it. The scene only says what the model's file is called.
std::vector<std::uint64_t> model_fingerprints(const scenes::Scene& scene, const sim::World& world);

}  // namespace pneuma::app

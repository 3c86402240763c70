// Scenes as people name them: a scene file, the name of one, or a model that becomes one.
#pragma once

#include <span>
#include <string>

#include "app/world/model_scene.h"
#include "scenes/loader/scene.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// Loads what find_scene finds; of a model file, the scene that model_scene.h makes. A scene that
/// names no step gets the steps that step_advice.h finds for its bodies, if these are at most
/// 100,000 a second, and a note in its warnings; but not where damping is by the step, as in the
/// paper. Throws scenes::SceneError, assets::ModelError, and UsageError if a choice is made of no
/// model.
scenes::Scene open_scene(const std::string& name, std::span<const std::string> overrides,
                         const ModelChoice& choice = {});

/// The world at the start of a scene that is to be run. Throws scenes::SceneError where bodies are
/// in each other, and as refuse_unstable_step does.
sim::World build_checked_world(const scenes::Scene& scene);

/// Throws scenes::SceneError where open_scene left steps in which the run would fail at once, as a
/// body needs more than it chooses: it says by what, and what to set. `start`: what build_world
/// made of the scene.
void refuse_unstable_step(const scenes::Scene& scene, const sim::World& start);

}  // namespace pneuma::app

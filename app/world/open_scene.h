// Scenes as people name them: a scene file, the name of one, or a model that becomes one.
#pragma once

#include <span>
#include <string>

#include "scenes/loader/scene.h"

namespace pneuma::app {

/// Loads what find_scene finds; of a model file, the scene that model_scene.h makes. Throws
/// scenes::SceneError and assets::ModelError.
scenes::Scene open_scene(const std::string& name, std::span<const std::string> overrides);

}  // namespace pneuma::app

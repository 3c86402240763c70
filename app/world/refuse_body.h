// Errors about a body that its scene file does not show.
#pragma once

#include <string>

#include "scenes/loader/scene.h"

namespace pneuma::app {

/// Throws scenes::SceneError: "body 'NAME': REASON", at the place, or in the scene's file where
/// that is not known.
[[noreturn]] void refuse_body(const scenes::Scene& scene, const scenes::Place& place,
                              const std::string& name, const std::string& reason);

}  // namespace pneuma::app

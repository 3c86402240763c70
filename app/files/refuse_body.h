// Errors about a body that its scene file does not show.
#pragma once

#include <string>

#include "scenes/loader/load_scene.h"

namespace pneuma::app {

/// "body 'NAME': REASON", at the place, or in the scene's file where that is not known.
scenes::Diagnostic body_diagnostic(const scenes::Scene& scene, const scenes::Place& place,
                                   const std::string& name, const std::string& reason);
/// Throws scenes::SceneError with that.
[[noreturn]] void refuse_body(const scenes::Scene& scene, const scenes::Place& place,
                              const std::string& name, const std::string& reason);

}  // namespace pneuma::app

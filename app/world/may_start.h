// Whether what a message would advise can be done.
#pragma once

#include <span>
#include <string>

#include "scenes/loader/scene.h"

namespace pneuma::app {

/// Whether a run can start from the scene with these overrides. Builds its world.
bool may_start_with(const scenes::Scene& scene, std::span<const std::string> overrides);

/// The same with contact as a potential, which refuses springs between bodies and starts that
/// touch, and this integrator.
bool may_use_potential(const scenes::Scene& scene, const std::string& integrator);

}  // namespace pneuma::app

// Turns of moved bodies that a step cannot tell from others.
#pragma once

#include "scenes/loader/scene.h"

namespace pneuma::app {

/// A step takes the shorter way from one orientation to the next. Throws scenes::SceneError if the
/// motion or the angular velocity of a moved body turns it by 180 degrees or more in one step.
void check_turns(const scenes::Scene& scene, const scenes::BodyScene& body);

}  // namespace pneuma::app

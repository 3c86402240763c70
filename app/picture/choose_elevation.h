// How high the automatic camera stands: high enough to look over walls.
#pragma once

#include "scenes/loader/scene.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// Degrees above the horizon: the scene's; or, where it gives none, 22, or as much more up to 82 as
/// it takes to see most of what can move past what stands still or is moved, where it would come to
/// lie if it fell along gravity alone; or to see as much of it as can be. A camera that follows a
/// body stands at 22. `from_all_around`: it goes around.
double choose_elevation(const scenes::Scene& scene, const sim::World& world, bool from_all_around);

}  // namespace pneuma::app

// What a scene puts between its bodies: valves and springs.
#pragma once

#include <memory>

#include "scenes/loader/scene.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// What changes the gas of a copy of the body; null if nothing does.
std::shared_ptr<const sim::GasSupply> gas_supply(const scenes::BodyScene& body);

/// Adds the scene's valves and springs to a world that has all bodies. Throws scenes::SceneError
/// for a name that no body has, for a body that cannot be an end, and for a region without
/// vertices.
void join_bodies(const scenes::Scene& scene, sim::World& world);

}  // namespace pneuma::app

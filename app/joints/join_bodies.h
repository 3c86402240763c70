// What a scene puts between its bodies: valves and springs.
#pragma once

#include <memory>

#include "scenes/loader/report.h"
#include "scenes/loader/scene.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// What changes the gas of a copy of the body; null if nothing does.
std::shared_ptr<const sim::GasSupply> gas_supply(const scenes::BodyScene& body);

/// Adds the scene's valves and springs to a world that has all bodies but those that were refused,
/// whose valves and springs it leaves out. Refuses springs that move nothing, and those with a
/// region without vertices; scenes/loader/check_joints.h has checked the names.
void join_bodies(const scenes::Scene& scene, sim::World& world, scenes::Refusals& refusals);

}  // namespace pneuma::app

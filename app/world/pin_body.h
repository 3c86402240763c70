// What a scene holds of its bodies.
#pragma once

#include <span>

#include "scenes/loader/report.h"
#include "scenes/loader/scene.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// Refuses each region of the body in which there is no vertex of its copies.
void check_regions(const scenes::Scene& scene, const scenes::BodyScene& body,
                   std::span<const sim::SoftBody> copies, scenes::Refusals& refusals);

/// Pins the vertices of a copy that are in the body's regions now. Those that follow its motion
/// turn about `position`, at which the copy starts.
void pin(const scenes::BodyScene& scene, const sim::Vec3& position, sim::SoftBody& body);

/// Makes an obstacle of a body that starts at `position`: it rests, or moves as its scene says.
void pin_all(const scenes::BodyScene& scene, const sim::Vec3& position, sim::SoftBody& body);

}  // namespace pneuma::app

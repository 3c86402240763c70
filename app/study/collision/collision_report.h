// What `pneuma study collision` leaves: text for people, CSV and JSON for programs, a diagram.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "app/study/collision/collision_study.h"
#include "app/study/diagram.h"

namespace pneuma::app {

/// A table per scene, and what follows.
std::string collision_text(const CollisionStudy& study);

/// A row per scene and setting.
std::string collision_csv(std::span<const CollisionStudy> studies);

/// An array with an object per scene.
nlohmann::json collision_json(std::span<const CollisionStudy> studies);

/// Share of the vertices within reach that are found, over the time of a step.
Diagram collision_diagram(const CollisionStudy& study);

}  // namespace pneuma::app

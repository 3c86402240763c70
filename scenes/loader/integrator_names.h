// The integrators by the words that scene files have for them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "sim/world/world.h"

namespace pneuma::scenes {

/// All there are, each once.
std::span<const std::pair<sim::Integrator, std::string_view>> integrator_names();

/// Of one of them.
std::string integrator_name(sim::Integrator integrator);

}  // namespace pneuma::scenes

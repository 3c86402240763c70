// The integrators that several test files run one by one.
#pragma once

#include <array>
#include <string>

#include "sim/world/settings.h"

namespace pneuma::sim {

inline constexpr std::array implicit_integrators = {Integrator::implicit_euler, Integrator::sdirk2};

inline std::string name(Integrator integrator) {
  return integrator == Integrator::sdirk2 ? "sdirk2" : "implicit_euler";
}

}  // namespace pneuma::sim

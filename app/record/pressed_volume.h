// Bodies that are pressed to next to nothing.
#pragma once

#include "sim/joints/gas_flow.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// Of its shape's volume: a body that keeps its gas is not meant to be pressed to less.
inline constexpr double pressed_fraction = 0.1;

/// Whether a soft body has gas, which neither comes nor goes.
inline bool keeps_gas(const sim::World& world, int soft) {
  return world.soft[sim::at(soft)].material.n > 0.0 && !sim::has_gas_flow(world, soft);
}

}  // namespace pneuma::app

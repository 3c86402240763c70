// The gas of a world's bodies in JSON.
#pragma once

#include "app/record/world_json.h"
#include "sim/joints/gas_flow.h"
#include "sim/mesh/measure.h"
#include "sim/soft/gas_law.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// Of each body that has gas, or may get some: n in mol, and in Pa how far its pressure is above
/// that outside.
template <class Json>
Json gas_of_bodies_json(const sim::World& world) {
  Json gas = Json::object();
  for (int i = 0; i < sim::soft_count(world); ++i) {
    const sim::SoftBody& body = world.soft[sim::at(i)];
    const sim::GasLaw law = sim::gas_law(body.material);
    if (!(law.strength > 0.0 || sim::has_gas_flow(world, i))) continue;
    const double volume = sim::volume(body.mesh->topology, body.positions);
    gas[body.name] = {{"n", body.material.n},
                      {"gauge_pressure", number_json<Json>(sim::gauge_pressure(law, volume))}};
  }
  return gas;
}

}  // namespace pneuma::app

#include "app/world/fill_body.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/files/refuse_body.h"
#include "app/world/settled_volume.h"
#include "sim/mesh/measure.h"
#include "sim/soft/gas_law.h"

namespace pneuma::app {
namespace {

/// mol of gas that has the pressure P, in Pa, at the volume V.
double moles(const sim::SoftMaterial& material, double absolute, double volume) {
  sim::SoftMaterial one_mol = material;
  one_mol.n = 1.0;
  return absolute / sim::absolute_pressure(sim::gas_law(one_mol), volume);
}

/// P in Pa with which the body is at rest at the volume.
double pressure_at_rest(const scenes::Scene& scene, const scenes::BodyScene& body,
                        const sim::SoftBody& alone, double volume) {
  const auto held = held_pressure(alone, volume);
  if (!held) {
    refuse_body(scene, body.place, body.name,
                fmt::format("inflation = {}: no balance of springs and gas was found at that "
                            "volume; give n or gauge_pressure",
                            *body.inflation));
  }
  return scene.ambient_pressure + std::max(0.0, *held);  // -0 and the like where inflation is 1
}

sim::SoftMaterial skin_material(const scenes::BodyScene& body, const sim::SoftMesh& mesh) {
  sim::SoftMaterial material = body.material;
  if (body.stiffness) material.k = k_per_stiffness * *body.stiffness;
  if (body.skin_mass) {
    material.vertex_mass = *body.skin_mass / mesh.topology.vertex_count();
  } else if (body.density) {
    const double area = sim::surface_area(mesh.topology, mesh.rest_positions);
    material.vertex_mass = *body.density * body.thickness * area / mesh.topology.vertex_count();
  }
  return material;
}

/// Keys keep their first value until its time has come.
double at_start(const std::vector<scenes::TimedValue>& keys) { return keys.front()[1]; }

}  // namespace

sim::SoftMaterial filled_material(const scenes::Scene& scene, const scenes::BodyScene& body,
                                  const std::shared_ptr<const sim::SoftMesh>& mesh) {
  sim::SoftBody alone;
  alone.mesh = mesh;
  alone.material = skin_material(body, *mesh);
  if (!body.supply_n.empty()) alone.material.n = at_start(body.supply_n);
  if (!body.supply_temperature.empty()) {
    alone.material.temperature = at_start(body.supply_temperature);
  }
  alone.positions = mesh->rest_positions;
  alone.velocities = sim::VertexArray(mesh->topology.vertex_count());
  sim::SoftMaterial& material = alone.material;
  const double start = sim::volume(mesh->topology, mesh->rest_positions);
  if (!(start > 0.0)) return material;
  material.start_volume = start;
  material.ambient_pressure = scene.ambient_pressure;
  if (body.gauge_pressure) {
    material.n = moles(material, *body.gauge_pressure + scene.ambient_pressure, start);
  } else if (body.inflation) {
    const double volume = *body.inflation * start;
    material.n = moles(material, pressure_at_rest(scene, body, alone, volume), volume);
  }
  return material;
}

}  // namespace pneuma::app

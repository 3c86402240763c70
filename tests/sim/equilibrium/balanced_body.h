// Bodies whose springs balance their gas, and what is left of the forces on them.
#pragma once

#include "sim/equilibrium/equilibrium.h"
#include "sim/soft/acceleration.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {

/// A body in the shape of its mesh, with rest lengths for it.
inline SoftBody balanced_body(const TriangleMesh& mesh, const SoftMaterial& material,
                              const EquilibriumOptions& options) {
  SoftBody body = make_body(mesh);
  body.material = material;
  const Equilibrium found =
      find_equilibrium(body.mesh->topology, body.positions, body.material, options);
  body.mesh = make_soft_mesh(*body.mesh, found.rest_lengths);
  return body;
}

/// Whatever is left of forces, over the pressure force alone, both as norms over all vertices. By
/// the simulation's own force, which knows nothing of how the rest lengths were found.
inline double unbalanced(const SoftBody& body) {
  const auto force = [&](double k) {
    SoftMaterial material = body.material;
    material.k = k;
    AccelerationScratch scratch(*body.mesh);
    VertexArray result(body.positions.size());
    SoftAcceleration(*body.mesh, material, Vec3::Zero(), scratch)(body.positions, body.velocities,
                                                                  result);
    return result.rows().norm();
  };
  return force(body.material.k) / force(0.0);
}

/// Gas for a pressure in Pa in the shape of the mesh.
inline SoftMaterial inflated(const TriangleMesh& mesh, double pressure, double k) {
  SoftMaterial material;
  material.k = k;
  material.k_max = 2.0 * k;
  const SoftBody body = make_body(mesh);
  material.n = pressure * volume(body.mesh->topology, body.positions) /
               (gas_constant * material.temperature);
  return material;
}

}  // namespace pneuma::sim

#include "sim/soft/acceleration.h"

#include <algorithm>

#include "sim/soft/bending.h"
#include "sim/soft/damping.h"
#include "sim/soft/pressure_force.h"
#include "sim/soft/spring_force.h"

namespace pneuma::sim {

SoftAcceleration::SoftAcceleration(const SoftMesh& mesh, const SoftMaterial& material,
                                   const Vec3& gravity, AccelerationScratch& scratch)
    : mesh_(mesh),
      scratch_(scratch),
      gravity_{gravity.x(), gravity.y(), gravity.z(), 0.0},
      inverse_mass_(1.0 / material.vertex_mass),
      k_(material.k),
      bending_(mesh.hinges ? material.bending : 0.0),
      bending_damping_(material.bending_damping),
      dashpot_(dashpot_constant(material)),
      drag_(drag_rate(material)),
      gas_(gas_law(material)),
      valence_(material.pressure_weighting == PressureWeighting::valence) {}

Accelerations SoftAcceleration::evaluate(const VertexArray& positions,
                                         const VertexArray& velocities) const {
  std::vector<double>& coefficients = scratch_.coefficients;
  RingForces& forces = scratch_.forces;
  if (k_ > 0.0) {
    spring_coefficients(mesh_, positions, velocities, k_, dashpot_, coefficients);
  } else {
    std::fill(coefficients.begin(), coefficients.end(), 0.0);
  }
  const double volume = gather_rings(mesh_.tables, positions, coefficients, forces);
  if (bending_ > 0.0) {
    constexpr int stride = RingForces::springs(1);
    if (bending_damping_ > 0.0) {
      add_damped_bending_forces(*mesh_.hinges, positions, velocities, bending_, bending_damping_,
                                stride, forces.rows());
    } else {
      add_bending_forces(*mesh_.hinges, positions, bending_, stride, forces.rows());
    }
  }
  if (valence_) {
    for (int v = 0; v < positions.size(); ++v) {
      forces.rows()[RingForces::six_volume_gradients(v)] *= mesh_.valence_weights[at(v)];
    }
  }

  Accelerations result(forces, velocities);
  result.gravity_ = gravity_;
  result.drag_ = drag_;
  result.inverse_mass_ = inverse_mass_;
  if (gas_.strength > 0.0) {
    result.volume_ = volume;
    result.sixth_pressure_over_mass_ = gauge_pressure(gas_, volume) * inverse_mass_ / 6.0;
  }
  return result;
}

double SoftAcceleration::operator()(const VertexArray& positions, const VertexArray& velocities,
                                    VertexArray& acceleration) const {
  const Accelerations a = evaluate(positions, velocities);
  const VertexWriter out(acceleration);
  for (int v = 0; v < positions.size(); ++v) out.put(v, a[v]);
  return a.volume();
}

}  // namespace pneuma::sim

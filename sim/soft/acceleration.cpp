#include "sim/soft/acceleration.h"

#include "sim/soft/damping.h"
#include "sim/soft/pressure_force.h"
#include "sim/soft/spring_force.h"

namespace pneuma::sim {
namespace {

/// acceleration_v += inverse_mass * sum over the ring of coefficient (neighbour - v). Each edge's
/// coefficient is used once from either end, so that internal forces cancel to the last bit but
/// sums.
void add_edge_forces(const MeshTopology& topology, const VertexArray& positions,
                     const std::vector<double>& coefficients, double inverse_mass,
                     VertexArray& acceleration) {
  for (int v = 0; v < topology.vertex_count(); ++v) {
    const Eigen::Vector4d centre = positions.rows().col(v);
    Eigen::Vector4d force = Eigen::Vector4d::Zero();
    for (const auto& spoke : topology.ring(v)) {
      force += coefficients[at(spoke.edge)] * (positions.rows().col(spoke.vertex) - centre);
    }
    acceleration.rows().col(v) += inverse_mass * force;
  }
}

}  // namespace

SoftAcceleration::SoftAcceleration(const SoftMesh& mesh, const SoftMaterial& material,
                                   const Vec3& gravity, AccelerationScratch& scratch)
    : mesh_(mesh),
      scratch_(scratch),
      gravity_(gravity.x(), gravity.y(), gravity.z(), 0.0),
      inverse_mass_(1.0 / material.vertex_mass),
      k_(material.k),
      dashpot_(dashpot_constant(material)),
      drag_(drag_rate(material)),
      gas_(gas_strength(material)),
      valence_(material.pressure == PressureWeighting::valence) {}

double SoftAcceleration::operator()(const VertexArray& positions, const VertexArray& velocities,
                                    VertexArray& acceleration) const {
  auto& a = acceleration.rows();
  a.noalias() = (-drag_) * velocities.rows();
  a.colwise() += gravity_;

  if (k_ > 0.0) {
    spring_coefficients(mesh_, positions, k_, scratch_.coefficients);
    if (dashpot_ > 0.0) {
      add_dashpot_coefficients(mesh_, positions, velocities, dashpot_, scratch_.coefficients);
    }
    add_edge_forces(mesh_.topology, positions, scratch_.coefficients, inverse_mass_, acceleration);
  }

  if (gas_ == 0.0) return 1.0;
  volume_gradient(mesh_.topology, positions, scratch_.gradient);
  const double body_volume = volume(positions, scratch_.gradient);
  const double pressure_over_mass = gas_ / body_volume * inverse_mass_;
  if (valence_) {
    for (int v = 0; v < positions.size(); ++v) {
      a.col(v) +=
          mesh_.valence_weights[at(v)] * pressure_over_mass * scratch_.gradient.rows().col(v);
    }
  } else {
    a.noalias() += pressure_over_mass * scratch_.gradient.rows();
  }
  return body_volume;
}

}  // namespace pneuma::sim

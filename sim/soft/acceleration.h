// The model's one differential equation (DESIGN "The model"), as a function of positions and
// velocities: every integrator, study and reference solves exactly this.
//
//   m dv/dt = sum_springs [k (l - L) + c (v_rel . d)] d  +  w P dV/dx  +  m g  -  gamma m v
#pragma once

#include <vector>

#include "sim/soft/soft_mesh.h"
#include "sim/world.h"

namespace pneuma::sim {

/// Memory for one evaluation on meshes of one shape; contents mean nothing between calls.
struct AccelerationScratch {
  explicit AccelerationScratch(const SoftMesh& mesh)
      : coefficients(static_cast<std::size_t>(mesh.topology.edge_count())),
        gradient(mesh.topology.vertex_count()) {}

  std::vector<double> coefficients;
  VertexArray gradient;
};

class SoftAcceleration {
 public:
  /// Refers to the mesh and the scratch, which must outlive it.
  SoftAcceleration(const SoftMesh& mesh, const SoftMaterial& material, const Vec3& gravity,
                   AccelerationScratch& scratch);

  /// Writes dv/dt in m/s^2. Returns the volume in m^3 when the body has gas, else 1: a result that
  /// is not above zero (or not a number) says that the body turned inside out and the force means
  /// nothing.
  double operator()(const VertexArray& positions, const VertexArray& velocities,
                    VertexArray& acceleration) const;

 private:
  const SoftMesh& mesh_;
  AccelerationScratch& scratch_;
  Eigen::Vector4d gravity_;
  double inverse_mass_;
  double k_;
  double dashpot_;
  double drag_;
  double gas_;
  bool valence_;
};

}  // namespace pneuma::sim

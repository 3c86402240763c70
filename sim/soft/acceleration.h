// The model's one differential equation (README "The model"), as a function of positions and
// velocities: every integrator, study and reference solves exactly this.
//
//   m dv/dt = sum_springs [k (l - L) + c (v_rel . d)] d  +  w (P - p0) dV/dx  +  m g  -  gamma m v
//
// and the forces of hinges with their dashpots (bending.h) where the material resists bending.
#pragma once

#include <vector>

#include "sim/mesh/soft_mesh.h"
#include "sim/mesh/vec4d.h"
#include "sim/soft/gas_law.h"
#include "sim/soft/ring_forces.h"
#include "sim/world/soft_body.h"

namespace pneuma::sim {

/// Memory for one evaluation on meshes of one shape; contents mean nothing between calls.
struct AccelerationScratch {
  explicit AccelerationScratch(const SoftMesh& mesh)
      : coefficients(static_cast<std::size_t>(mesh.topology.edge_count())),
        forces(mesh.topology.vertex_count()) {}

  std::vector<double> coefficients;
  RingForces forces;
};

/// The accelerations at one state, put together vertex by vertex, so that an integrator takes each
/// straight into its own sums. Valid until the scratch is used again or a velocity changes; the
/// velocity of a vertex may change once its acceleration has been read.
class Accelerations {
 public:
  /// dv/dt in m/s^2.
  Vec4d operator[](int vertex) const {
    const Vec4d dragged = fma(-drag_, velocities_[vertex], gravity_);
    const Vec4d sprung = fma(inverse_mass_, forces_[RingForces::springs(vertex)], dragged);
    return fma(sixth_pressure_over_mass_, forces_[RingForces::six_volume_gradients(vertex)],
               sprung);
  }

  /// m^3 when the body has gas, else 1. Not above zero, or not a number: the body turned inside out
  /// and the accelerations mean nothing.
  double volume() const { return volume_; }

 private:
  friend class SoftAcceleration;
  Accelerations(const RingForces& forces, const VertexArray& velocities)
      : forces_(forces.rows()), velocities_(velocities) {}

  VertexReader forces_;
  VertexReader velocities_;
  Vec4d gravity_{};
  double drag_ = 0.0;
  double inverse_mass_ = 0.0;
  double sixth_pressure_over_mass_ = 0.0;
  double volume_ = 1.0;
};

class SoftAcceleration {
 public:
  /// Refers to the mesh and the scratch, which must outlive it.
  SoftAcceleration(const SoftMesh& mesh, const SoftMaterial& material, const Vec3& gravity,
                   AccelerationScratch& scratch);

  /// Of gas that comes and goes between steps.
  void set_gas(const SoftMaterial& material) { gas_ = gas_law(material); }

  /// The scratch holds what the result reads.
  Accelerations evaluate(const VertexArray& positions, const VertexArray& velocities) const;

  /// Writes dv/dt in m/s^2. Returns the volume in m^3 when the body has gas, else 1: a result that
  /// is not above zero (or not a number) says that the body turned inside out and the force means
  /// nothing.
  double operator()(const VertexArray& positions, const VertexArray& velocities,
                    VertexArray& acceleration) const;

 private:
  const SoftMesh& mesh_;
  AccelerationScratch& scratch_;
  Vec4d gravity_;
  double inverse_mass_;
  double k_;
  double bending_;
  double bending_damping_;
  double dashpot_;
  double drag_;
  GasLaw gas_;
  bool valence_;
};

}  // namespace pneuma::sim

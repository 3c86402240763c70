// One implicit Euler step of a soft body, on a ground or in the air, as a minimisation: what both
// implicit integrators are made of (implicit_step.h says what is minimised, and why).
#pragma once

#include <vector>

#include "sim/soft/bending.h"
#include "sim/soft/minimise_energy.h"
#include "sim/soft/soft_state.h"
#include "sim/world/soft_body.h"

namespace pneuma::sim {

/// That by whose changes the dashpots of springs and hinges act.
struct Deformation {
  /// Takes memory.
  explicit Deformation(const SoftMesh& mesh);

  std::vector<double> lengths;     // m, of the edges
  std::vector<HingeState> hinges;  // none without dashpots
};

void measure(const SoftMesh& mesh, const SoftMaterial& material, const VertexArray& positions,
             Deformation& deformation);

/// Makes of `to` what is `factor` times as far from `from`, with the dashpots that act there.
void extrapolate(const Deformation& from, double factor, Deformation& to);

/// The state that a step starts from.
struct EulerBase {
  explicit EulerBase(const SoftMesh& mesh);

  SoftState state;
  Deformation deformation;
};

/// Fills in inertia, target, springs and hinges with dashpots, and gas of a step of `beta` seconds
/// from `base`: all but bounds and friction.
void set_step_energy(const SoftMesh& mesh, const SoftMaterial& material, const Vec3& gravity,
                     double beta, const EulerBase& base, IncrementalPotential& energy);

class EulerSolver {
 public:
  /// Refers to the mesh, which must outlive it. Takes memory for all that follows.
  explicit EulerSolver(const SoftMesh& mesh);

  /// For the following steps of a body. `friction` is Coulomb's coefficient against the ground.
  void set_body(const SoftMaterial& material, const Vec3& gravity, double friction);
  /// No ground, or at and above which height (m) each vertex is to stay.
  void set_no_ground() { energy_.ground = false; }
  void set_floor(int vertex, double height);
  /// Null: no vertex is pinned. Others keep the velocity that they have at the start of a step. To
  /// be called after the floor is set, which is none for these.
  void set_pins(const Pins* pins);

  /// Of the vertices' springs.
  double mean_rest_length() const { return mean_rest_length_; }

  /// Steps `beta` seconds from `base`. `guess` are positions with V > 0 and not below the floor:
  /// the energy at the step's end is at most that of the guess. Returns false when its volume is
  /// not above 0 by more than rounding, or something is not finite.
  [[nodiscard]] bool step(double beta, const EulerBase& base, const VertexArray& guess);

  const VertexArray& positions() const { return positions_; }  // where the last step ended
  /// Whether the ground held a vertex up over the last step.
  bool is_pushed(int vertex) const { return energy_.ground && normal_force(vertex) > 0.0; }

  struct Effort {
    int iterations = 0;
    int factorizations = 0;
    bool converged = true;
  };
  /// Of all steps since set_body().
  const Effort& effort() const { return effort_; }

 private:
  void set_energy(double beta, const EulerBase& base);
  bool begin(const VertexArray& guess, bool from_here);
  void put_where_allowed(VertexArray& positions) const;
  bool has_pins() const { return energy_.is_pinned != nullptr; }
  double normal_force(int v) const { return minimiser_.floor_force(energy_, v); }
  void predict_friction(const EulerBase& base);
  bool correct_friction();
  void keep_momentum();

  const SoftMesh& mesh_;
  EnergyMinimiser minimiser_;
  IncrementalPotential energy_;
  VertexArray positions_;
  double mean_rest_length_;
  SoftMaterial material_;
  Vec3 gravity_ = Vec3::Zero();
  double friction_ = 0.0;
  Effort effort_;
};

}  // namespace pneuma::sim

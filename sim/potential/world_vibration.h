// Small motions of all bodies of a world together, of which some touch, with contact as a
// potential:
//
//   M u'' = -K u - D u',   K = d^2(E + B)/dx^2,   D = dashpots, drag and friction.
//
// E is the energy of springs, hinges and gas, B the contact potential (contact_potential.h). Well
// below the regularisation speed v_0 friction acts as a dashpot of 2 mu lambda / v_0 along a
// surface that pushes with lambda; restitution acts on what parts, and vanishes with its speed.
// Free boxes move and turn.
//
// Explicit integrators are stable on the fastest of these motions up to a longest step, which
// stability_limit finds. What is hit hard is stiffer than what lies still.
#pragma once

#include "sim/potential/world_energy.h"
#include "sim/soft/stability_limit.h"

namespace pneuma::sim {

class WorldVibration {
 public:
  /// About the world as it lies, without the drag of boxes. Throws std::invalid_argument where
  /// bodies are in each other or inside out, whose energy has no value.
  explicit WorldVibration(const World& world);

  bool in_contact() const { return !point_.active.empty(); }

  /// That of the largest squared_frequency + weight * decay.
  Oscillation fastest(double weight);

 private:
  void find_masses();
  void set_matrix(double beta);
  void scale(VertexArray& values) const;
  Eigen::VectorXd times_matrix(const Eigen::VectorXd& u);

  World world_;
  ContactSurfaces surfaces_;
  WorldEnergy energy_;
  std::vector<EulerBase> bases_;
  std::vector<RigidState> box_bases_;
  WorldPoint point_;
  VertexArray still_;                 // m/s: nothing moves
  std::vector<double> inverse_root_;  // M^-1/2 of vertices and ways of boxes, kg^-1/2
  std::vector<Mat3> of_turns_;        // and of the turns of boxes, (kg m^2)^-1/2
  WorldMatrix matrix_;
  VertexArray values_, product_;
};

/// The longest stable step; infinite for implicit integrators.
StabilityLimit stability_limit(WorldVibration& motions, Integrator integrator);

}  // namespace pneuma::sim

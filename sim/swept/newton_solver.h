// Impulses that depend on each other, improved all at once.
//
// Gauss-Seidel iterations carry a load by one body in each; in a tall stack, or among very
// different masses, thousands would be needed. Here the changes of velocity V of all that the
// impulses move are solved for together. Every impulse lambda grows with what is missing (an
// augmented Lagrangian of the contact problem; Alart and Curnier 1991, "A mixed formulation for
// frictional contact problems prone to Newton like solution methods"), so that
//   M V - J^T lambda(J V),
// M being the masses and J the levers, is the gradient of a convex function of V, and Newton's
// method with a line search finds where it vanishes. The limit of a friction impulse is the one
// that its normal impulse allowed before.
#pragma once

#include <span>
#include <vector>

#include "sim/swept/contact_nodes.h"
#include "sim/swept/envelope_cholesky.h"

namespace pneuma::sim {

class NewtonSolver {
 public:
  /// Improves the impulses, the more the greater the `penalty` is: of what each would need if it
  /// acted alone. False, and nothing is changed, if that would take longer than many Gauss-Seidel
  /// iterations, or if it does not converge.
  bool improve(std::span<SweptImpulse* const> impulses, double penalty);

 private:
  bool is_small();
  void read_velocities();
  /// The residual and the matrix of the system at the velocities.
  void assemble(std::span<SweptImpulse* const> impulses, double penalty);
  void add_masses();
  void add(const SweptImpulse::Response& response, std::span<const ContactLever> levers);
  double potential(std::span<SweptImpulse* const> impulses, double penalty) const;
  bool descend(std::span<SweptImpulse* const> impulses, double penalty);
  void move(double fraction);
  Vec4d relative_change(std::span<const ContactLever> levers) const;
  Vec3 part(const ContactNode& node, int first) const;

  ContactNodes nodes_;
  std::vector<int> first_columns_;
  std::vector<double> velocities_;  // V
  std::vector<double> residual_;    // J^T lambda(J V) - M V, then the step
  std::vector<Mat3> inertias_;      // of the nodes that are boxes
  EnvelopeCholesky matrix_;
};

}  // namespace pneuma::sim

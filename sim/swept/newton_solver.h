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

/// Of the change of a lever's velocity by those of its node.
using LeverJacobian = Eigen::Matrix<double, 3, 6>;

class NewtonSolver {
 public:
  /// Finds what the impulses move. False if to improve them would take longer than many
  /// Gauss-Seidel iterations.
  bool begin(std::span<SweptImpulse* const> impulses);
  /// Improves the impulses of the last `begin`, the more the greater the `penalty` is: of what each
  /// would need if it acted alone. False, and nothing is changed, if that does not converge.
  bool improve(double penalty);

 private:
  /// Of the convex function along a step, and by how much it grows there.
  struct Slope {
    double value = 0.0, growth = 0.0;
  };

  bool is_small();
  void read_velocities();
  /// All responses at the velocities.
  void respond(double penalty);
  /// The residual and the matrix of the system at the velocities, from the responses there.
  void assemble();
  void add_masses();
  void add(const SweptImpulse::Response& response, std::span<const ContactLever> levers,
           std::span<const LeverJacobian> jacobians);
  /// Moves the velocities along the step, which the residual has become, to about where the
  /// function is least there. False if it does not fall at first.
  bool descend(double penalty);
  /// All responses at a fraction of the step.
  Slope respond_along(double fraction, double penalty);
  /// Of two vectors of unknowns by the masses.
  double product(std::span<const double> one, std::span<const double> other) const;
  /// Of a contact's sides against each other, by the unknowns.
  Vec4d relative(std::span<const ContactLever> levers, std::span<const double> unknowns) const;

  std::span<SweptImpulse* const> impulses_;
  ContactNodes nodes_;
  std::vector<int> first_columns_;
  std::vector<double> velocities_;        // V
  std::vector<double> residual_;          // J^T lambda(J V) - M V, then the step
  std::vector<Mat3> inertias_;            // of the nodes that are boxes
  std::vector<LeverJacobian> jacobians_;  // of the levers
  std::vector<SweptImpulse::Response> responses_;
  std::vector<Vec4d> changes_;                // of the relative velocities, at V
  std::vector<Vec4d> ways_;                   // and by the step
  double by_velocity_ = 0.0, by_step_ = 0.0;  // products of the step with V and with itself
  EnvelopeCholesky matrix_;
};

}  // namespace pneuma::sim

// Eigenvalues of an equation of motion, by differences of its accelerations.
#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>

#include "sim/soft/explicit_step.h"

namespace pneuma::sim {

/// The largest of -M^1/2 da/dx M^-1/2, or of da/dv, by central differences over `h` (m or m/s);
/// `mass_of` says the mass of a vertex.
template <class Acceleration, class MassOf>
double greatest_eigenvalue(const Acceleration& acceleration, const SoftState& rest,
                           const MassOf& mass_of, bool of_velocities, double h) {
  const int count = rest.positions.size();
  Eigen::MatrixXd matrix(3 * count, 3 * count);
  VertexArray plus(count), minus(count);
  for (int i = 0; i < 3 * count; ++i) {
    SoftState state = rest;
    double& moved = (of_velocities ? state.velocities : state.positions).rows()(i % 3, i / 3);
    moved += h;
    acceleration(state.positions, state.velocities, plus);
    moved -= 2.0 * h;
    acceleration(state.positions, state.velocities, minus);
    for (int v = 0; v < count; ++v) {
      matrix.block<3, 1>(3 * v, i) =
          -std::sqrt(mass_of(v) / mass_of(i / 3)) * (plus[v] - minus[v]) / (2.0 * h);
    }
  }
  const Eigen::MatrixXd symmetric = 0.5 * (matrix + matrix.transpose());
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric).eigenvalues().maxCoeff();
}

}  // namespace pneuma::sim

// Vibration modes: small motions of a body about a state of rest:
//
//   u'' = -K u - D u',    m K = d^2E/dx^2 of springs, hinges and gas,    m D = dashpots and drag.
//
// Hinges and their dashpots act in full (bending.h: s1 s2 = 1, f = 1), as in triangles that keep
// their area.
#pragma once

#include <Eigen/Core>

#include "sim/mesh/soft_mesh.h"
#include "sim/world/soft_body.h"

namespace pneuma::sim {

/// A motion x'' = -frequency^2 x - decay x'.
struct Oscillation {
  double squared_frequency = 0.0;  // rad^2/s^2; not below 0
  double decay = 0.0;              // 1/s
};

class VibrationMode {
 public:
  /// The pressure is taken as uniform: `valence` shifts it by the tenth part or so between
  /// vertices. Refers to the mesh, which must outlive it.
  VibrationMode(const SoftMesh& mesh, const SoftMaterial& material, const VertexArray& positions);

  /// The motion u of the largest u.K u + weight u.D u, of size 1.
  Eigen::VectorXd fastest(double weight) const;
  /// The motion u of the largest weight u.D u - u.K u, of size 1.
  Eigen::VectorXd most_damped(double weight) const;
  /// A motion near u, of size 1 as u is: the fastest that a few products with K find. For where u
  /// is fast already, and `fastest` takes too long.
  Eigen::VectorXd faster_than(const Eigen::VectorXd& u) const;
  /// Of the motion along u alone, a vector of size 1.
  Oscillation along(const Eigen::VectorXd& u) const;

 private:
  /// (K + weight D) u.
  Eigen::VectorXd product(const Eigen::VectorXd& u, double weight) const;
  void add_springs(const Eigen::VectorXd& u, double weight, Eigen::VectorXd& result) const;
  void add_hinges(const Eigen::VectorXd& u, double weight, Eigen::VectorXd& result) const;
  void add_gas(const Eigen::VectorXd& u, Eigen::VectorXd& result) const;

  const SoftMesh& mesh_;
  double stiffness_;              // k / m, 1/s^2
  double dashpot_;                // c / m, 1/s
  double bending_damping_;        // s
  double drag_;                   // 1/s
  double pressure_;               // (P - p0) / m, 1/(m s^2)
  double rank_one_;               // g P / (V m), 1/(m^4 s^2)
  std::vector<Vec3> directions_;  // of the edges
  std::vector<double> stretch_;   // of the edges: 1 - L / l
  std::vector<Vec3> across_;      // m, of the edges: between the vertices on their two sides
  VertexArray area_;              // dV/dx, m^2
  /// Of the hinges, 1/s: hinge_stiffness_root over the root of m. What hinges out of their rest
  /// angle add, as springs out of their rest length do, is left out: it is small where they yield.
  std::vector<Eigen::Matrix<double, 12, 1>> hinges_;
};

}  // namespace pneuma::sim

#include "sim/equilibrium/equilibrium.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <string>

#include "sim/base/text.h"
#include "sim/mesh/edge_length.h"
#include "sim/mesh/measure.h"
#include "sim/soft/pressure_force.h"

namespace pneuma::sim {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Rounds of the proximal iteration: what is given up falls off steeply at the softening.
constexpr int rounds = 10;

/// Instead of a softening of 0, as a fraction of k: far below the stiffness of any load that a mesh
/// of sane triangles balances, far above the 1e-15 to which the equations are solved.
constexpr double min_softening = 1e-9;

/// Net force and torque up to which they are rounding, as a fraction of the sum of all forces.
constexpr double equilibrium_rounding = 1e-9;

/// The pressure force on every vertex in N, as one column x0 y0 z0 x1 ...
Eigen::VectorXd pressure_force(const MeshTopology& topology, const VertexArray& positions,
                               const SoftMaterial& material) {
  const int count = topology.vertex_count();
  VertexArray gradient(count);
  volume_gradient(topology, positions, gradient);
  const double enclosed = volume(positions, gradient);
  if (!(enclosed > 0.0)) {
    throw EquilibriumError("the shape's volume is " + base::text(enclosed) +
                           " m^3: gas needs a volume above zero, its triangles must be "
                           "counter-clockwise from outside");
  }
  const double pressure = gauge_pressure(gas_law(material), enclosed);
  const double mean_springs = 2.0 * topology.edge_count() / count;
  Eigen::VectorXd force(3 * count);
  for (int v = 0; v < count; ++v) {
    const bool valence = material.pressure_weighting == PressureWeighting::valence;
    const double springs = static_cast<double>(topology.ring(v).size());
    force.segment<3>(3 * v) = (valence ? springs / mean_springs : 1.0) * pressure * gradient[v];
  }
  return force;
}

/// Springs pull on both ends alike: they balance neither a net force nor a net torque.
void check_balance(const VertexArray& positions, const Eigen::VectorXd& force) {
  const Vec3 centre = mean(positions);
  Vec3 net = Vec3::Zero(), torque = Vec3::Zero();
  double sum = 0.0, sum_of_moments = 0.0;
  for (int v = 0; v < positions.size(); ++v) {
    const Vec3 here = force.segment<3>(3 * v);
    const Vec3 arm = positions[v] - centre;
    net += here;
    torque += arm.cross(here);
    sum += here.norm();
    sum_of_moments += arm.norm() * here.norm();
  }
  if (net.norm() <= equilibrium_rounding * sum &&
      torque.norm() <= equilibrium_rounding * sum_of_moments)
    return;
  throw EquilibriumError("the pressure has a net force of " + base::text(net.norm()) +
                         " N and a net torque of " + base::text(torque.norm()) +
                         " N m, which springs cannot balance: give the pressure by area "
                         "(pressure_weighting = \"uniform\") or start without (rest = \"shape\")");
}

/// Column e holds the force of a tension of 1 N in spring e on every vertex.
Sparse spring_directions(const MeshTopology& topology, const VertexArray& positions) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int e = 0; e < topology.edge_count(); ++e) {
    const auto& [a, b] = topology.edges()[at(e)];
    const Vec3 direction = (positions[b] - positions[a]).normalized();
    for (int axis = 0; axis < 3; ++axis) {
      entries.emplace_back(3 * a + axis, e, direction[axis]);
      entries.emplace_back(3 * b + axis, e, -direction[axis]);
    }
  }
  Sparse result(3 * topology.vertex_count(), topology.edge_count());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// D t = -f for the smallest t, where D D^T is k's stiffness over k. The exact t = -D^T (D D^T)^-1
/// f does not exist for rigid motions, and is enormous for motions that hardly stretch a spring.
/// With s added to the diagonal, a load of the stiffness q k is balanced to the fraction q / (q +
/// s), and after n rounds on what is left over, to 1 - (s / (q + s))^n.
Balance solve(const Sparse& directions, const Eigen::VectorXd& force, double softening) {
  Sparse stiffness = directions * Sparse(directions.transpose());
  Sparse identity(stiffness.rows(), stiffness.cols());
  identity.setIdentity();
  stiffness += std::max(softening, min_softening) * identity;
  const Eigen::SimplicialLDLT<Sparse> solver(stiffness);
  if (solver.info() != Eigen::Success) {
    throw EquilibriumError("the equations of the springs cannot be solved: an edge has no length");
  }
  Eigen::VectorXd tensions = Eigen::VectorXd::Zero(directions.cols());
  Eigen::VectorXd left = -force;
  for (int i = 0; i < rounds; ++i) {
    tensions += directions.transpose() * solver.solve(left);
    left = -force - directions * tensions;
  }
  return {{tensions.begin(), tensions.end()}, left.norm() / force.norm()};
}

void check_residual(double residual, double max_residual) {
  if (residual <= max_residual) return;
  throw EquilibriumError(
      "the springs leave " + base::text(residual) + " of the pressure force unbalanced, " +
      base::text(max_residual) +
      " is allowed: its faces are too flat to be held by springs along them. Use "
      "a rounder shape, or springs at rest in the shape (rest = \"shape\"), and "
      "bending where it is to keep its faces");
}

struct Strain {
  int edge = -1;       // -1: none is stretched
  double value = 0.0;  // (l - L) / l; from 1 on L would not be above zero
};

Strain find_greatest_strain(const std::vector<double>& lengths, const std::vector<double>& tensions,
                            double k) {
  Strain greatest;
  for (std::size_t e = 0; e < tensions.size(); ++e) {
    const double strain = tensions[e] / (k * lengths[e]);
    if (strain > greatest.value) greatest = {static_cast<int>(e), strain};
  }
  return greatest;
}

void check_strain(const MeshTopology& topology, const VertexArray& positions, const Strain& strain,
                  const SoftMaterial& material) {
  if (strain.value < 1.0) return;
  const double balanced = balanced_gas(topology, positions, material);
  const auto& [a, b] = topology.edges()[at(strain.edge)];
  SoftMaterial most = material;
  most.n = balanced + (material.n - balanced) / strain.value;
  const double pressure = gauge_pressure(gas_law(most), volume(topology, positions));
  throw EquilibriumError(
      "n = " + base::text(material.n) + " mol of gas is more than the springs can hold: at k = " +
      base::text(material.k) + " N/m and " + base::text(material.temperature) +
      " K at most n = " + base::text_below(most.n) + " mol, a gauge_pressure of " +
      (pressure > 0.0 ? base::text_below(pressure) : base::text(pressure)) +
      " Pa, where the spring of edge " + std::to_string(a) + "-" + std::to_string(b) +
      " would have no rest length left. Use no more gas than that, or at least k = " +
      base::text_above(material.k * strain.value) + " N/m");
}

std::vector<double> edge_lengths(const MeshTopology& topology, const VertexArray& positions) {
  std::vector<double> lengths;
  for (const auto& [a, b] : topology.edges()) {
    lengths.push_back(edge_length(positions[b] - positions[a]));
  }
  return lengths;
}

}  // namespace

Balance find_balance(const MeshTopology& topology, const VertexArray& positions,
                     const SoftMaterial& material, double softening) {
  if (!(material.k > 0.0)) {
    throw EquilibriumError("k = " + base::text(material.k) +
                           " N/m: without springs nothing balances the gas; k must be above zero");
  }
  const Eigen::VectorXd force = pressure_force(topology, positions, material);
  if (force.isZero(0.0)) return {std::vector<double>(at(topology.edge_count())), 0.0};
  check_balance(positions, force);
  return solve(spring_directions(topology, positions), force, softening);
}

double balanced_gas(const MeshTopology& topology, const VertexArray& positions,
                    const SoftMaterial& material) {
  if (material.ambient_pressure == 0.0) return 0.0;
  SoftMaterial one_mol = material;
  one_mol.n = 1.0;
  return material.ambient_pressure /
         absolute_pressure(gas_law(one_mol), volume(topology, positions));
}

double greatest_strain(const MeshTopology& topology, const VertexArray& positions,
                       const SoftMaterial& material, const std::vector<double>& tensions) {
  return find_greatest_strain(edge_lengths(topology, positions), tensions, material.k).value;
}

std::vector<double> rest_lengths(const MeshTopology& topology, const VertexArray& positions,
                                 const SoftMaterial& material,
                                 const std::vector<double>& tensions) {
  std::vector<double> lengths = edge_lengths(topology, positions);
  check_strain(topology, positions, find_greatest_strain(lengths, tensions, material.k), material);
  for (std::size_t e = 0; e < lengths.size(); ++e) lengths[e] -= tensions[e] / material.k;
  return lengths;
}

Equilibrium find_equilibrium(const MeshTopology& topology, const VertexArray& positions,
                             const SoftMaterial& material, const EquilibriumOptions& options) {
  if (!(gas_strength(material) > 0.0)) return {edge_lengths(topology, positions), 0.0};
  const Balance balance = find_balance(topology, positions, material, options.softening);
  check_residual(balance.residual, options.max_residual);
  return {rest_lengths(topology, positions, material, balance.tensions), balance.residual};
}

}  // namespace pneuma::sim

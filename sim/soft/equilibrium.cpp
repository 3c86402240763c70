#include "sim/soft/equilibrium.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "sim/base/text.h"
#include "sim/mesh/edge_length.h"
#include "sim/mesh/measure.h"
#include "sim/soft/incremental_potential.h"
#include "sim/soft/pressure_force.h"
#include "sim/soft/vertex_matrix.h"

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
                         " N m, which springs cannot balance: use uniform pressure, not valence");
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

struct Tensions {
  Eigen::VectorXd values;  // N, per edge
  double residual;
};

/// D t = -f for the smallest t, where D D^T is k's stiffness over k. The exact t = -D^T (D D^T)^-1
/// f does not exist for rigid motions, and is enormous for motions that hardly stretch a spring.
/// With s added to the diagonal, a load of the stiffness q k is balanced to the fraction q / (q +
/// s), and after n rounds on what is left over, to 1 - (s / (q + s))^n.
Tensions solve(const Sparse& directions, const Eigen::VectorXd& force, double softening) {
  Sparse stiffness = directions * Sparse(directions.transpose());
  Sparse identity(stiffness.rows(), stiffness.cols());
  identity.setIdentity();
  stiffness += std::max(softening, min_softening) * identity;
  const Eigen::SimplicialLDLT<Sparse> solver(stiffness);
  if (solver.info() != Eigen::Success) {
    throw EquilibriumError("the equations of the springs cannot be solved: an edge has no length");
  }
  Tensions result{Eigen::VectorXd::Zero(directions.cols()), 1.0};
  Eigen::VectorXd left = -force;
  for (int i = 0; i < rounds; ++i) {
    result.values += directions.transpose() * solver.solve(left);
    left = -force - directions * result.values;
  }
  result.residual = left.norm() / force.norm();
  return result;
}

Tensions find_tensions(const MeshTopology& topology, const VertexArray& positions,
                       const SoftMaterial& material, const EquilibriumOptions& options) {
  if (!(material.k > 0.0)) {
    throw EquilibriumError("k = " + base::text(material.k) +
                           " N/m: without springs nothing balances the gas; k must be above zero");
  }
  const Eigen::VectorXd force = pressure_force(topology, positions, material);
  check_balance(positions, force);
  Tensions tensions = solve(spring_directions(topology, positions), force, options.softening);
  if (tensions.residual <= options.max_residual) return tensions;
  throw EquilibriumError(
      "the springs leave " + base::text(tensions.residual) + " of the pressure force unbalanced, " +
      base::text(options.max_residual) +
      " is allowed: its faces are too flat to be held by springs along them. Use "
      "a rounder shape, or springs at rest in the shape (rest = \"shape\"), and "
      "bending where it is to keep its faces");
}

/// mol, with which the gas pushes no more than what is outside; 0 without ambient pressure.
double balanced_gas(const MeshTopology& topology, const VertexArray& positions,
                    const SoftMaterial& material) {
  if (material.ambient_pressure == 0.0) return 0.0;
  SoftMaterial one_mol = material;
  one_mol.n = 1.0;
  return material.ambient_pressure /
         absolute_pressure(gas_law(one_mol), volume(topology, positions));
}

struct Strain {
  int edge = -1;       // -1: none is stretched
  double value = 0.0;  // (l - L) / l; from 1 on L would not be above zero
};

Strain greatest_strain(const std::vector<double>& lengths, const Tensions& tensions, double k) {
  Strain greatest;
  for (int e = 0; e < tensions.values.size(); ++e) {
    const double strain = tensions.values[e] / (k * lengths[at(e)]);
    if (strain > greatest.value) greatest = {e, strain};
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

/// The rigid motions, which take no energy, and q of the gas, whose part of d^2E/dx^2 is q q^T.
constexpr int rigid_motions = 6, low_rank = rigid_motions + 1;

std::vector<VertexArray> rigid_motions_and_gas(const IncrementalPotential& energy,
                                               const EnergyPoint& point) {
  const VertexArray& x = point.positions;
  std::vector<VertexArray> columns(low_rank, VertexArray(x.size()));
  const Vec3 centre = mean(x);
  for (int v = 0; v < x.size(); ++v) {
    const Vec3 arm = x[v] - centre;
    for (int axis = 0; axis < 3; ++axis) {
      columns[at(axis)][v] = Vec3::Unit(axis);
      columns[at(3 + axis)][v] = Vec3::Unit(axis).cross(arm);
    }
  }
  const double slope = energy.gas.strength > 0.0 ? pressure_slope(energy.gas, point.volume) : 0.0;
  columns.back().rows() = std::sqrt(slope) * point.volume_gradient.rows();
  return columns;
}

/// Negative eigenvalues of S + q q^T across the rigid motions R, S = L D L^T: as many as of D and
/// of -diag(0, 1) - B^T S^-1 B together, B = (R q), less the columns of B (Haynsworth 1968).
int negative_directions(const VertexMatrix& factors, const std::vector<VertexArray>& columns) {
  Eigen::Matrix<double, low_rank, low_rank> complement;
  for (int j = 0; j < low_rank; ++j) {
    VertexArray solved = columns[at(j)];
    factors.solve(solved);
    for (int i = 0; i < low_rank; ++i) complement(i, j) = -dot(columns[at(i)], solved);
  }
  complement(rigid_motions, rigid_motions) -= 1.0;
  // Metres and square metres side by side: to size 1, which leaves the signs.
  const auto scale = complement.diagonal().cwiseAbs().cwiseSqrt().cwiseInverse().eval();
  complement = (scale.asDiagonal() * complement * scale.asDiagonal()).eval();
  const auto values = complement.selfadjointView<Eigen::Lower>().eigenvalues();
  const auto negative = static_cast<int>((values.array() < 0.0).count());
  return factors.negative_count() + negative - low_rank;
}

}  // namespace

Equilibrium find_equilibrium(const MeshTopology& topology, const VertexArray& positions,
                             const SoftMaterial& material, const EquilibriumOptions& options) {
  Equilibrium result{edge_lengths(topology, positions), 0.0};
  if (!(gas_strength(material) > 0.0)) return result;
  const Tensions tensions = find_tensions(topology, positions, material, options);
  check_strain(topology, positions, greatest_strain(result.rest_lengths, tensions, material.k),
               material);
  for (int e = 0; e < topology.edge_count(); ++e) {
    result.rest_lengths[at(e)] -= tensions.values[e] / material.k;
  }
  result.residual = tensions.residual;
  return result;
}

std::shared_ptr<const SoftMesh> held_mesh(const SoftMesh& mesh, const VertexArray& positions,
                                          const SoftMaterial& material,
                                          const EquilibriumOptions& options) {
  return make_soft_mesh(mesh,
                        find_equilibrium(mesh.topology, positions, material, options).rest_lengths);
}

double max_held_gas(const MeshTopology& topology, const VertexArray& positions,
                    const SoftMaterial& material, const EquilibriumOptions& options) {
  SoftMaterial gas = material;
  gas.n = 1.0;
  gas.ambient_pressure = 0.0;  // tensions are in proportion to the rest of the gas
  const Tensions tensions = find_tensions(topology, positions, gas, options);
  const double strain =
      greatest_strain(edge_lengths(topology, positions), tensions, material.k).value;
  if (!(strain > 0.0)) return std::numeric_limits<double>::infinity();
  return gas.n / strain + balanced_gas(topology, positions, material);
}

bool is_stable(const SoftMesh& mesh, const VertexArray& positions, const SoftMaterial& material) {
  constexpr double rounding = 1e-9;  // of k: of no size beside any motion that is not rigid
  IncrementalPotential energy(mesh);
  energy.stiffness = material.k;
  energy.inertia = rounding * material.k;
  energy.rest_lengths = mesh.rest_lengths;
  energy.bending = material.bending;
  energy.gas = gas_law(material);
  energy.target = positions;
  EnergyPoint point(mesh);
  point.positions = positions;
  if (!evaluate(mesh, energy, point)) return false;
  VertexMatrix hessian(mesh.topology, mesh.hinges.get());
  hessian_without_rank_one(mesh, energy, point, opposite_vertices(mesh.topology), hessian);
  return hessian.factorize() &&
         negative_directions(hessian, rigid_motions_and_gas(energy, point)) <= 0;
}

double stable_stiffness(const SoftMesh& mesh, const VertexArray& positions,
                        const SoftMaterial& material, const EquilibriumOptions& options) {
  constexpr double most = 1e3, precision = 1.02;
  SoftMaterial stiff = material;
  const auto stable = [&](double k) {
    stiff.k = k;
    return is_stable(*held_mesh(mesh, positions, stiff, options), positions, stiff);
  };
  if (stable(material.k)) return material.k;
  double low = material.k, high = 2.0 * material.k;
  for (; !stable(high); high *= 2.0) {
    if (high > most * material.k) return std::numeric_limits<double>::infinity();
    low = high;
  }
  while (high > precision * low) {
    const double middle = std::sqrt(low * high);
    (stable(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace pneuma::sim

#include "sim/equilibrium/held_shape.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <vector>

#include "sim/mesh/measure.h"
#include "sim/soft/incremental_potential.h"
#include "sim/soft/vertex_matrix.h"

namespace pneuma::sim {
namespace {

/// Of the pressure force, left unbalanced: more changes the volume by more than a tenth; less is
/// reached where more is left.
constexpr double much_left = 0.1, little_left = 0.03;
/// Each softening after the first over the one before; none below the last is tried.
constexpr double less_softening = 0.3, last_softening = 1e-3;
/// What is left over what the softening before left, from which on less changes nothing: flat
/// faces.
constexpr double no_less = 0.99;

/// From the softening that asks least of the springs to the one that leaves little unbalanced.
std::vector<Balance> find_balances(const SoftMesh& mesh, const VertexArray& positions,
                                   const SoftMaterial& material) {
  constexpr EquilibriumOptions options;
  std::vector<Balance> balances;
  double wanted = much_left, before = 2.0, softening = options.softening;
  for (; softening >= last_softening; softening *= less_softening) {
    Balance balance = find_balance(mesh.topology, positions, material, softening);
    const double left = balance.residual;
    if (left <= options.max_residual) balances.push_back(std::move(balance));
    if (left <= wanted || left > no_less * before) break;
    wanted = little_left;
    before = left;
  }
  if (!balances.empty()) return balances;
  find_equilibrium(mesh.topology, positions, material, options);  // which throws, and says why
  throw EquilibriumError("the springs do not balance the pressure");
}

std::shared_ptr<const SoftMesh> with_tensions(const SoftMesh& mesh, const VertexArray& positions,
                                              const SoftMaterial& material,
                                              const Balance& balance) {
  return make_soft_mesh(mesh, rest_lengths(mesh.topology, positions, material, balance.tensions));
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

std::shared_ptr<const SoftMesh> held_mesh(const SoftMesh& mesh, const VertexArray& positions,
                                          const SoftMaterial& material) {
  if (!(gas_strength(material) > 0.0)) {
    return make_soft_mesh(mesh, find_equilibrium(mesh.topology, positions, material).rest_lengths);
  }
  const std::vector<Balance> balances = find_balances(mesh, positions, material);
  for (std::size_t i = balances.size() - 1; i > 0; --i) {
    if (greatest_strain(mesh.topology, positions, material, balances[i].tensions) >= 1.0) continue;
    auto held = with_tensions(mesh, positions, material, balances[i]);
    if (is_stable(*held, positions, material)) return held;
  }
  return with_tensions(mesh, positions, material, balances.front());
}

double max_held_gas(const SoftMesh& mesh, const VertexArray& positions,
                    const SoftMaterial& material) {
  SoftMaterial gas = material;
  gas.n = 1.0;
  gas.ambient_pressure = 0.0;  // tensions are in proportion to the rest of the gas
  const double outside = balanced_gas(mesh.topology, positions, material);
  const auto most = [&](const Balance& balance) {
    const double strain = greatest_strain(mesh.topology, positions, gas, balance.tensions);
    return strain > 0.0 ? gas.n / strain : std::numeric_limits<double>::infinity();
  };
  const auto lasts = [&](Balance balance, double n) {
    constexpr double just_below = 0.999;
    SoftMaterial filled = material;
    filled.n = just_below * n + outside;
    for (double& tension : balance.tensions) tension *= just_below * n / gas.n;
    return is_stable(*with_tensions(mesh, positions, filled, balance), positions, filled);
  };
  const std::vector<Balance> balances = find_balances(mesh, positions, gas);
  for (std::size_t i = balances.size() - 1; i > 0; --i) {
    const double n = most(balances[i]);
    if (std::isinf(n) || lasts(balances[i], n)) return n + outside;
  }
  return most(balances.front()) + outside;
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
                        const SoftMaterial& material) {
  constexpr double most = 1e3, precision = 1.02;
  SoftMaterial stiff = material;
  const auto stable = [&](double k) {
    stiff.k = k;
    return is_stable(*held_mesh(mesh, positions, stiff), positions, stiff);
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

#include "sim/soft/minimise_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pneuma::sim {
namespace {

using Vec2 = Eigen::Vector2d;

/// Fraction of an energy's terms by which its value may be off: 1e-16 for each of their sum's
/// roundings, of which some hundred do not cancel.
constexpr double energy_rounding_fraction = 1e-13;

constexpr double armijo_fraction = 1e-4;
constexpr int max_line_search_halvings = 60;

/// Fraction of nRT that the last iteration may still promise to take. A body thinner than the
/// tolerance moves by little and yet has far to go: every iteration doubles its volume.
constexpr double small_promise = 1e-8;

/// Fraction of the volume that an iteration leaves at least: closer to 0 the way back is long.
constexpr double min_volume_left = 0.01;

/// Steps after which E stands still to rounding, but the positions may still become better.
constexpr int max_polishing = 3;

/// Old factors are kept as long as they shrink the directions at least so much. A solution with
/// them costs a tenth of new ones or less.
constexpr double quick = 0.1;

/// Diagonal shift as a fraction of the inertia, where one is needed; below `negligible` there is
/// none.
constexpr double first_shift = 0.1;
constexpr double negligible_shift = 0.02;
constexpr double shift_factor = 4.0;
/// Fraction of the largest diagonal element: what is lost in rounding would not help.
constexpr double min_shift = 1e-13;

double max_size(const VertexArray& values) {
  return std::sqrt(values.rows().colwise().squaredNorm().maxCoeff());
}

}  // namespace

EnergyMinimiser::EnergyMinimiser(const SoftMesh& mesh)
    : mesh_(mesh),
      opposite_(opposite_vertices(mesh.topology)),
      matrix_(mesh.topology, mesh.hinges.get()),
      point_(mesh),
      trial_(mesh),
      gradient_(mesh.topology.vertex_count()),
      other_gradient_(mesh.topology.vertex_count()),
      direction_(mesh.topology.vertex_count()),
      rank_one_(mesh.topology.vertex_count()),
      rank_one_solved_(mesh.topology.vertex_count()),
      active_set_(at(mesh.topology.vertex_count())),
      conjugate_gradients_(mesh.topology.vertex_count()) {}

void EnergyMinimiser::update_gradient(const IncrementalPotential& energy) {
  gradient_without_gas(mesh_, energy, point_, other_gradient_);
  gradient_.rows() = other_gradient_.rows();
  if (energy.gas.strength > 0.0) {
    gradient_.rows() -= pressure(energy, point_) * point_.volume_gradient.rows();
  }
}

double EnergyMinimiser::floor_force(const IncrementalPotential& energy, int vertex) const {
  if (point_.positions[vertex].z() > energy.floor[at(vertex)]) return 0.0;
  return std::max(0.0, gradient_[vertex].z());
}

/// Active set: heights of floor vertices with an outward gradient (Bertsekas, Projected Newton
/// methods, 1982), x and y of vertices at their friction anchors, and all of pinned ones.
void EnergyMinimiser::find_active_set(const IncrementalPotential& energy) {
  if (!has_bounds(energy)) return;
  for (int v = 0; v < gradient_.size(); ++v) {
    const bool pinned = is_pinned(energy, v);
    const ActiveBounds active{
        pinned || (energy.ground && floor_force(energy, v) > 0.0),
        pinned || (energy.ground && energy.friction && energy.anchored[at(v)])};
    has_factors_ &= active == active_set_[at(v)];
    active_set_[at(v)] = active;
  }
  clear_active(gradient_);
  clear_active(other_gradient_);
}

void EnergyMinimiser::clear_active(VertexArray& values) const {
  for (int v = 0; v < values.size(); ++v) {
    if (active_set_[at(v)].height) values[v].z() = 0.0;
    if (active_set_[at(v)].anchor) values[v].head<2>().setZero();
  }
}

/// S, with `diagonal_shift_` on the diagonal, and q.
void EnergyMinimiser::find_hessian(const IncrementalPotential& energy) {
  has_factors_ = false;
  hessian_without_rank_one(mesh_, energy, point_, opposite_, matrix_);
  matrix_.add_identity(diagonal_shift_);
  for (int v = 0; has_bounds(energy) && v < gradient_.size(); ++v) {
    if (active_set_[at(v)].anchor) {
      matrix_.fix(v, 0);
      matrix_.fix(v, 1);
    }
    if (active_set_[at(v)].height) matrix_.fix(v, 2);
  }
  find_rank_one(energy);
}

void EnergyMinimiser::find_rank_one(const IncrementalPotential& energy) {
  if (energy.gas.strength > 0.0) {
    rank_one_.rows() =
        std::sqrt(pressure_slope(energy.gas, point_.volume)) * point_.volume_gradient.rows();
    if (has_bounds(energy)) clear_active(rank_one_);
  } else {
    rank_one_.rows().setZero();
  }
}

/// False when S + q q^T cannot be positive definite.
bool EnergyMinimiser::factorize(const IncrementalPotential& energy) {
  factors_inertia_ = energy.inertia;
  has_factors_ =
      matrix_.factorize() && matrix_.negative_count() <= (energy.gas.strength > 0.0 ? 1 : 0);
  return has_factors_;
}

/// p = -H^-1 dE/dx from the factors of S. False when H is not positive definite.
bool EnergyMinimiser::solve(const IncrementalPotential& energy) {
  direction_.rows() = -other_gradient_.rows();
  matrix_.solve(direction_);
  if (energy.gas.strength > 0.0) {
    const double p = absolute_pressure(energy.gas, point_.volume);
    const double gauge_fraction = 1.0 - energy.gas.ambient_pressure / p;
    rank_one_solved_.rows() = rank_one_.rows();
    matrix_.solve(rank_one_solved_);
    const double denominator = 1.0 + dot(rank_one_, rank_one_solved_);
    if ((denominator > 0.0) != (matrix_.negative_count() == 0)) return false;
    // The gas's own gradient is -sqrt(PV / g) (1 - p0 / P) q. Put together by hand, since the two
    // terms of the formula for it are far greater than what is left of them.
    const double along_solved =
        (std::sqrt(p * point_.volume / energy.gas.exponent) * gauge_fraction -
         dot(rank_one_, direction_)) /
        denominator;
    direction_.rows() += along_solved * rank_one_solved_.rows();
  }
  return dot(gradient_, direction_) <= 0.0;
}

/// With the factors of an earlier iteration, if that does: when the direction comes out much
/// shorter than the last one was.
bool EnergyMinimiser::find_direction_by_old_factors(const IncrementalPotential& energy,
                                                    double last_size) {
  has_factors_ &= diagonal_shift_ == 0.0 && factors_inertia_ == energy.inertia;
  if (!has_factors_) return false;
  find_rank_one(energy);
  return solve(energy) && max_size(direction_) < quick * last_size;
}

bool EnergyMinimiser::use_conjugate_gradients(const IncrementalPotential& energy) const {
  return !gradients_were_slow_ && ConjugateGradients::promises_to_be_quick(
                                      gradient_.size(), energy.stiffness, energy.inertia);
}

void EnergyMinimiser::find_direction(const IncrementalPotential& energy, MinimiserReport& report) {
  using End = ConjugateGradients::End;
  if (diagonal_shift_ < negligible_shift * energy.inertia) diagonal_shift_ = 0.0;
  while (std::isfinite(diagonal_shift_)) {  // ends at the latest when all else is negligible
    find_hessian(energy);
    End end = End::too_slow;
    if (use_conjugate_gradients(energy)) {
      end = conjugate_gradients_.solve(matrix_, rank_one_, gradient_, direction_);
      gradients_were_slow_ = end == End::too_slow;
    }
    if (end == End::solved) return;
    if (end == End::too_slow) {
      ++report.factorizations;
      if (factorize(energy) && solve(energy)) return;
    }
    const double shift = std::max(first_shift * energy.inertia, min_shift * matrix_.max_diagonal());
    diagonal_shift_ = std::max(shift_factor * diagonal_shift_, shift);
  }
}

/// Sets the trial point to point + fraction * direction. A vertex stops at the floor, and at the
/// kink of friction's energy if it would slide past it: else the one whose kink comes first would
/// stop all the others.
void EnergyMinimiser::take_trial_step(const IncrementalPotential& energy, double fraction) {
  trial_.positions.rows() = point_.positions.rows() + fraction * direction_.rows();
  is_stopped_ = false;
  for (int v = 0; energy.ground && v < direction_.size(); ++v) {
    if (trial_.positions[v].z() < energy.floor[at(v)]) {
      trial_.positions[v].z() = energy.floor[at(v)];
      is_stopped_ = true;
    }
    if (!energy.friction || energy.friction_bound[at(v)] == 0.0) continue;
    const Vec2 before = slide(energy, point_.positions, v);
    const Vec2 ahead = slide(energy, trial_.positions, v) - before;
    if (before.norm() <= energy.regularisation_length || before.dot(before + ahead) >= 0.0)
      continue;
    trial_.positions[v].head<2>() -= (1.0 + before.dot(ahead) / ahead.squaredNorm()) * ahead;
    is_stopped_ = true;
  }
}

/// Backtracking line search. Returns the fraction of the direction that was taken; 0 when none
/// helped.
double EnergyMinimiser::search_line(const IncrementalPotential& energy) {
  double fraction = 1.0;
  for (int i = 0; i <= max_line_search_halvings; ++i, fraction *= 0.5) {
    take_trial_step(energy, fraction);
    if (!evaluate(mesh_, energy, trial_)) continue;
    if (trial_.volume < min_volume_left * point_.volume) continue;
    const double promised =
        gradient_.rows().cwiseProduct(trial_.positions.rows() - point_.positions.rows()).sum();
    if (trial_.energy <= point_.energy + armijo_fraction * std::min(promised, 0.0) +
                             energy_rounding_fraction * trial_.magnitude) {
      std::swap(point_, trial_);
      return fraction;
    }
  }
  return 0.0;
}

MinimiserReport EnergyMinimiser::minimise(const IncrementalPotential& energy, double tolerance) {
  MinimiserReport report;
  diagonal_shift_ = 0.0;
  double last_size = std::numeric_limits<double>::infinity();  // of the last direction
  int polishing = 0;
  const double gas_scale =
      energy.gas.strength > 0.0 ? energy.gas.strength : std::numeric_limits<double>::infinity();
  while (report.iterations < max_newton_iterations && !report.converged) {
    update_gradient(energy);
    find_active_set(energy);
    if (!find_direction_by_old_factors(energy, last_size)) find_direction(energy, report);
    ++report.iterations;
    const double size = max_size(direction_);
    const double promise = -dot(gradient_, direction_);
    const double fraction = search_line(energy);
    if (!(promise > energy_rounding_fraction * point_.magnitude)) ++polishing;
    // The directions shrink by the same factor again, of which the first one does not tell.
    const bool full = fraction == 1.0 && !is_stopped_ && diagonal_shift_ == 0.0;
    const double shrinking =
        full && last_size > 0.0 && std::isfinite(last_size)
            ? std::clamp(size / last_size, ConjugateGradients::forcing_term, 1.0)
            : 1.0;
    report.converged = (size * shrinking <= tolerance && promise <= small_promise * gas_scale) ||
                       fraction == 0.0 || polishing > max_polishing;
    last_size = full ? size : 0.0;
    diagonal_shift_ /= shift_factor;
  }
  return report;
}

}  // namespace pneuma::sim

#include "sim/soft/minimise_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pneuma::sim {
namespace {

using Vec2 = Eigen::Vector2d;

/// Share of an energy's terms by which its value may be off: 1e-16 for each of their sum's
/// roundings, of which some hundred do not cancel.
constexpr double rounding = 1e-13;

constexpr double armijo_share = 1e-4;
constexpr int greatest_halvings = 60;

/// Of nRT, what the last iteration may still promise to take. A body thinner than the tolerance
/// moves by little and yet has far to go: every iteration doubles its volume.
constexpr double small_promise = 1e-8;

/// Of the volume, what an iteration leaves at least: closer to 0 the way back is long.
constexpr double least_volume_left = 0.01;

/// Steps after which E stands still to rounding, but the positions may still become better.
constexpr int greatest_polishing = 3;

/// Old factors are kept as long as they shrink the directions at least so much. A solution with
/// them costs a tenth of new ones or less.
constexpr double quick = 0.1;

/// Of the inertia, where some must be added; below `negligible` of it none is.
constexpr double first_addition = 0.1;
constexpr double negligible_addition = 0.02;
constexpr double addition_factor = 4.0;
/// Of the greatest diagonal element: what is lost in rounding would not help.
constexpr double least_addition = 1e-13;

double greatest_size(const VertexArray& values) {
  return std::sqrt(values.rows().colwise().squaredNorm().maxCoeff());
}

}  // namespace

EnergyMinimiser::EnergyMinimiser(const SoftMesh& mesh)
    : mesh_(mesh),
      opposite_(opposite_vertices(mesh.topology)),
      matrix_(mesh.topology),
      point_(mesh),
      trial_(mesh),
      gradient_(mesh.topology.vertex_count()),
      other_gradient_(mesh.topology.vertex_count()),
      direction_(mesh.topology.vertex_count()),
      rank_one_(mesh.topology.vertex_count()),
      rank_one_solved_(mesh.topology.vertex_count()),
      pinned_(at(mesh.topology.vertex_count())),
      conjugate_gradients_(mesh.topology.vertex_count()) {}

void EnergyMinimiser::update_gradient(const StepEnergy& energy) {
  gradient_without_gas(mesh_, energy, point_, other_gradient_);
  gradient_.rows() = other_gradient_.rows();
  if (energy.gas > 0.0) {
    gradient_.rows() -= pressure(energy, point_) * point_.volume_gradient.rows();
  }
}

double EnergyMinimiser::floor_force(const StepEnergy& energy, int vertex) const {
  if (point_.positions[vertex].z() > energy.floor[at(vertex)]) return 0.0;
  return std::max(0.0, gradient_[vertex].z());
}

/// Of the vertices on the floor, the heights of those that E would push through it (Bertsekas,
/// Projected Newton methods, 1982), and the places of those that friction holds.
void EnergyMinimiser::find_pinned(const StepEnergy& energy) {
  if (!energy.ground) return;
  for (int v = 0; v < gradient_.size(); ++v) {
    const Pins pins{floor_force(energy, v) > 0.0, energy.friction && energy.held[at(v)]};
    has_factors_ &= pins == pinned_[at(v)];
    pinned_[at(v)] = pins;
  }
  clear_pinned(gradient_);
  clear_pinned(other_gradient_);
}

void EnergyMinimiser::clear_pinned(VertexArray& values) const {
  for (int v = 0; v < values.size(); ++v) {
    if (pinned_[at(v)].height) values[v].z() = 0.0;
    if (pinned_[at(v)].place) values[v].head<2>().setZero();
  }
}

/// S, with `added_inertia_` on the diagonal, and q.
void EnergyMinimiser::find_hessian(const StepEnergy& energy) {
  has_factors_ = false;
  hessian_without_rank_one(mesh_, energy, point_, opposite_, matrix_);
  matrix_.add_identity(added_inertia_);
  for (int v = 0; energy.ground && v < gradient_.size(); ++v) {
    if (pinned_[at(v)].place) {
      matrix_.pin(v, 0);
      matrix_.pin(v, 1);
    }
    if (pinned_[at(v)].height) matrix_.pin(v, 2);
  }
  find_rank_one(energy);
}

void EnergyMinimiser::find_rank_one(const StepEnergy& energy) {
  if (energy.gas > 0.0) {
    rank_one_.rows() =
        std::sqrt(pressure(energy, point_) / point_.volume) * point_.volume_gradient.rows();
    if (energy.ground) clear_pinned(rank_one_);
  } else {
    rank_one_.rows().setZero();
  }
}

/// False when S + q q^T cannot be positive definite.
bool EnergyMinimiser::factorize(const StepEnergy& energy) {
  factors_inertia_ = energy.inertia;
  has_factors_ = matrix_.factorize() && matrix_.negative_count() <= (energy.gas > 0.0 ? 1 : 0);
  return has_factors_;
}

/// p = -H^-1 dE/dx from the factors of S. False when H is not positive definite.
bool EnergyMinimiser::solve(const StepEnergy& energy) {
  direction_.rows() = -other_gradient_.rows();
  matrix_.solve(direction_);
  if (energy.gas > 0.0) {
    const double p = pressure(energy, point_);
    rank_one_solved_.rows() = rank_one_.rows();
    matrix_.solve(rank_one_solved_);
    const double denominator = 1.0 + dot(rank_one_, rank_one_solved_);
    if ((denominator > 0.0) != (matrix_.negative_count() == 0)) return false;
    // The gas's own gradient is -sqrt(PV) q. Put together by hand, since the two terms of the
    // formula for it are far greater than what is left of them.
    const double share = (std::sqrt(p * point_.volume) - dot(rank_one_, direction_)) / denominator;
    direction_.rows() += share * rank_one_solved_.rows();
  }
  return dot(gradient_, direction_) <= 0.0;
}

/// With the factors of an earlier iteration, if that does: when the direction comes out much
/// shorter than the last one was.
bool EnergyMinimiser::find_direction_by_old_factors(const StepEnergy& energy, double last_size) {
  has_factors_ &= added_inertia_ == 0.0 && factors_inertia_ == energy.inertia;
  if (!has_factors_) return false;
  find_rank_one(energy);
  return solve(energy) && greatest_size(direction_) < quick * last_size;
}

bool EnergyMinimiser::use_conjugate_gradients(const StepEnergy& energy) const {
  return !gradients_were_slow_ && ConjugateGradients::promises_to_be_quick(
                                      gradient_.size(), energy.stiffness, energy.inertia);
}

void EnergyMinimiser::find_direction(const StepEnergy& energy, MinimiserReport& report) {
  using End = ConjugateGradients::End;
  if (added_inertia_ < negligible_addition * energy.inertia) added_inertia_ = 0.0;
  while (std::isfinite(added_inertia_)) {  // ends at the latest when all else is negligible
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
    const double least =
        std::max(first_addition * energy.inertia, least_addition * matrix_.greatest_diagonal());
    added_inertia_ = std::max(addition_factor * added_inertia_, least);
  }
}

/// Goes to point + share * direction. A vertex stops at the floor, and at the kink of friction's
/// energy if it would slide past it: else the one whose kink comes first would stop all the others.
void EnergyMinimiser::go(const StepEnergy& energy, double share) {
  trial_.positions.rows() = point_.positions.rows() + share * direction_.rows();
  is_stopped_ = false;
  for (int v = 0; energy.ground && v < direction_.size(); ++v) {
    if (trial_.positions[v].z() < energy.floor[at(v)]) {
      trial_.positions[v].z() = energy.floor[at(v)];
      is_stopped_ = true;
    }
    if (!energy.friction || energy.grip[at(v)] == 0.0) continue;
    const Vec2 before = slide(energy, point_.positions, v);
    const Vec2 ahead = slide(energy, trial_.positions, v) - before;
    if (before.norm() <= energy.slip || before.dot(before + ahead) >= 0.0) continue;
    trial_.positions[v].head<2>() -= (1.0 + before.dot(ahead) / ahead.squaredNorm()) * ahead;
    is_stopped_ = true;
  }
}

/// Backtracks along the direction. Returns the share of it that was gone; 0 when nothing helped.
double EnergyMinimiser::descend(const StepEnergy& energy) {
  double share = 1.0;
  for (int i = 0; i <= greatest_halvings; ++i, share *= 0.5) {
    go(energy, share);
    if (!evaluate(mesh_, energy, trial_)) continue;
    if (trial_.volume < least_volume_left * point_.volume) continue;
    const double promised =
        gradient_.rows().cwiseProduct(trial_.positions.rows() - point_.positions.rows()).sum();
    if (trial_.energy <=
        point_.energy + armijo_share * std::min(promised, 0.0) + rounding * trial_.magnitude) {
      std::swap(point_, trial_);
      return share;
    }
  }
  return 0.0;
}

MinimiserReport EnergyMinimiser::minimise(const StepEnergy& energy, double tolerance) {
  MinimiserReport report;
  added_inertia_ = 0.0;
  double last_size = std::numeric_limits<double>::infinity();  // of the last direction
  int polishing = 0;
  const double least_gas = energy.gas > 0.0 ? energy.gas : std::numeric_limits<double>::infinity();
  while (report.iterations < greatest_iterations && !report.converged) {
    update_gradient(energy);
    find_pinned(energy);
    if (!find_direction_by_old_factors(energy, last_size)) find_direction(energy, report);
    ++report.iterations;
    const double size = greatest_size(direction_);
    const double promise = -dot(gradient_, direction_);
    const double share = descend(energy);
    if (!(promise > rounding * point_.magnitude)) ++polishing;
    // The directions shrink by the same factor again, of which the first one does not tell.
    const bool full = share == 1.0 && !is_stopped_ && added_inertia_ == 0.0;
    const double shrinking =
        full && last_size > 0.0 && std::isfinite(last_size)
            ? std::clamp(size / last_size, ConjugateGradients::forcing_term, 1.0)
            : 1.0;
    report.converged = (size * shrinking <= tolerance && promise <= small_promise * least_gas) ||
                       share == 0.0 || polishing > greatest_polishing;
    last_size = full ? size : 0.0;
    added_inertia_ /= addition_factor;
  }
  return report;
}

}  // namespace pneuma::sim

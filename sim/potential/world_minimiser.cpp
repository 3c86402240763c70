#include "sim/potential/world_minimiser.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/soft/vertex_matrix.h"

namespace pneuma::sim {
namespace {

constexpr int max_world_iterations = 200;
/// Fraction of an energy's terms by which its value may be off (minimise_energy.cpp).
constexpr double world_energy_rounding = 1e-13;
constexpr double world_armijo = 1e-4;
constexpr int max_world_halvings = 50;
/// Fraction of nRT that the last iteration may still promise to take (minimise_energy.cpp).
constexpr double small_world_promise = 1e-8;
/// Of each volume, that an iteration leaves at least.
constexpr double min_world_volume_left = 0.01;
constexpr int max_world_polishing = 3;
/// Of a pair's distance, which an iteration leaves at least.
constexpr double kept_distance = 0.1;
/// After so many iterations the contacts' second derivative is taken whole: where distances curve,
/// what is left of it converges only slowly.
constexpr int quick_iterations = 12;
/// Of a way that keys prescribe: an iteration that goes less far goes nowhere.
constexpr double least_progress = 1e-4;
constexpr int max_blocked = 8;
constexpr int max_arrival_iterations = 60;

constexpr double first_world_shift = 0.1;
constexpr double world_shift_factor = 4.0;
constexpr double min_shrinking = 1e-3;

double max_way(const VertexArray& values) {
  return std::sqrt(values.rows().colwise().squaredNorm().maxCoeff());
}

}  // namespace

WorldMinimiser::WorldMinimiser(const ContactSurfaces& surfaces, const WorldEnergy& energy)
    : surfaces_(surfaces),
      energy_(energy),
      finder_(surfaces),
      matrix_(surfaces.mobile()),
      point_(energy.make_point()),
      trial_(energy.make_point()),
      gradient_(surfaces.vertex_count()),
      right_(surfaces.vertex_count()),
      direction_(surfaces.vertex_count()),
      given_(surfaces.vertex_count()),
      ahead_(surfaces.vertex_count()) {}

bool WorldMinimiser::begin() {
  finder_.find(point_.positions, point_.positions, 0.0, pairs_);
  return energy_.evaluate(pairs_, point_);
}

bool WorldMinimiser::is_arrived() const {
  for (int v = 0; v < point_.positions.size(); ++v) {
    if (!surfaces_.is_mobile(v) && point_.positions[v] != energy_.targets()[v]) return false;
  }
  return true;
}

/// p = -H^-1 dE/dx for what forces move, given the ways of what keys move.
void WorldMinimiser::find_direction(int iteration) {
  energy_.gradient(point_, gradient_);
  const bool is_whole = iteration >= quick_iterations;
  energy_.hessian(point_, is_whole ? ContactHessian::positive : ContactHessian::along_normals,
                  matrix_);
  for (int v = 0; v < given_.size(); ++v) {
    given_[v] = surfaces_.is_mobile(v) ? Vec3(Vec3::Zero())
                                       : Vec3(energy_.targets()[v] - point_.positions[v]);
  }
  matrix_.multiply(given_, right_);
  right_.rows() = -gradient_.rows() - right_.rows();
  for (int v = 0; v < right_.size(); ++v) {
    if (!surfaces_.is_mobile(v)) right_[v].setZero();
  }
  if (shift_ < 0.02 * energy_.inertia()) shift_ = 0.0;
  while (std::isfinite(shift_)) {
    if (matrix_.solve(right_, shift_, direction_) != WorldMatrix::End::not_positive) break;
    shift_ = std::max(world_shift_factor * shift_, first_world_shift * energy_.inertia());
  }
  direction_.rows() += given_.rows();
}

/// Returns the fraction of the direction that was taken; 0 when none helped.
double WorldMinimiser::search_line(bool arrived, WorldMinimiserReport& report) {
  ahead_.rows() = point_.positions.rows() + direction_.rows();
  finder_.find(point_.positions, ahead_, 0.0, pairs_);
  const WayLimit limit = limit_ways(surfaces_, pairs_, point_.positions, ahead_, kept_distance);
  report.blocked = limit;
  if (limit.pair >= 0) report.blocked_pair = pairs_[at(limit.pair)];
  double fraction = limit.fraction;
  for (int i = 0; i <= max_world_halvings; ++i, fraction *= 0.5) {
    trial_.positions.rows() =
        fraction == 1.0 ? ahead_.rows() : point_.positions.rows() + fraction * direction_.rows();
    for (int v = 0; fraction == 1.0 && v < given_.size(); ++v) {
      if (!surfaces_.is_mobile(v)) trial_.positions[v] = energy_.targets()[v];
    }
    if (!energy_.evaluate(pairs_, trial_)) continue;
    bool keeps_volume = true;
    for (std::size_t b = 0; b < trial_.bodies.size(); ++b) {
      keeps_volume &= trial_.bodies[b].volume >= min_world_volume_left * point_.bodies[b].volume;
    }
    if (!keeps_volume) continue;
    const double promised = fraction * dot(gradient_, direction_);
    if (!arrived || trial_.energy <= point_.energy + world_armijo * std::min(promised, 0.0) +
                                         world_energy_rounding * trial_.magnitude) {
      std::swap(point_, trial_);
      return fraction;
    }
  }
  return 0.0;
}

WorldMinimiserReport WorldMinimiser::minimise(double tolerance) {
  WorldMinimiserReport report;
  shift_ = 0.0;
  double last_size = std::numeric_limits<double>::infinity();
  int polishing = 0, blocked = 0;
  bool arrived = is_arrived();
  while (report.iterations < max_world_iterations && !report.converged) {
    find_direction(report.iterations);
    ++report.iterations;
    const double size = max_way(direction_);
    const double promise = -dot(gradient_, direction_);
    const double fraction = search_line(arrived, report);
    if (!arrived) {
      if (fraction < least_progress && ++blocked >= max_blocked) break;
      if (report.iterations >= max_arrival_iterations) break;
      arrived = is_arrived();
      last_size = 0.0;
      continue;
    }
    if (!(promise > world_energy_rounding * point_.magnitude)) ++polishing;
    const bool full = fraction == 1.0 && shift_ == 0.0;
    const double shrinking = full && last_size > 0.0 && std::isfinite(last_size)
                                 ? std::clamp(size / last_size, min_shrinking, 1.0)
                                 : 1.0;
    report.converged =
        (size * shrinking <= tolerance && promise <= small_world_promise * energy_.gas_scale()) ||
        fraction == 0.0 || polishing > max_world_polishing;
    last_size = full ? size : 0.0;
    shift_ /= world_shift_factor;
  }
  report.arrived = arrived;
  return report;
}

}  // namespace pneuma::sim

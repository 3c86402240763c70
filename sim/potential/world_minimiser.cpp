#include "sim/potential/world_minimiser.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/rigid/rigid_motion.h"
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
/// The same of poses beside straight ways that keep it.
constexpr double kept_beside = 0.05;
/// How much shorter than a way that is free a turn beside it is tried.
constexpr double shortened = 0.7;
constexpr int max_besides = 30;
/// How far around ways pairs are looked for, as the next iteration's end near: of the longest way,
/// and of the greatest reach, which is a fraction of the edges, at least and at most.
constexpr double way_around = 0.25;
constexpr double least_reaches_around = 0.5;
constexpr double most_reaches_around = 4.0;
/// rad, by which a box turns at most in an iteration, so that it is never turned inside out.
constexpr double max_turn_per_iteration = 1.0;
/// Along a direction of negative curvature E has no minimum by its derivatives: an iteration goes
/// at most so much further than the last, or than the reach.
constexpr double max_growth = 10.0;
/// After so many iterations the contacts' second derivative is taken whole: where distances curve,
/// what is left of it converges only slowly.
constexpr int quick_iterations = 8;

/// Eisenstat & Walker, Choosing the forcing terms in an inexact Newton method, 1996, choice 2, with
/// what the last two iterations promised in place of squared residuals.
constexpr double max_forcing = 0.03;
constexpr double min_forcing = 1e-3;
constexpr double forcing_factor = 0.5;
/// Of a way that keys prescribe: an iteration that goes less far goes nowhere.
constexpr double least_progress = 1e-4;
constexpr int max_blocked = 8;
constexpr int max_arrival_iterations = 60;

constexpr double first_world_shift = 0.1;
constexpr double world_shift_factor = 4.0;
constexpr double min_shrinking = 1e-3;

/// Of what is free: less was taken because E did not fall as its derivatives had it. Then those of
/// friction and restitution, whose forces turn within a short way, are replaced by bounds, until
/// iterations are not longer than so many of these ways.
constexpr double halved_fraction = 0.9;
constexpr double long_way = 10.0;

/// Of free boxes only the columns that carry their coordinates.
std::vector<std::uint8_t> mobile_coordinates(const ContactSurfaces& surfaces,
                                             const WorldEnergy& energy) {
  std::vector<std::uint8_t> mobile = surfaces.mobile();
  for (const WorldEnergy::Box& box : energy.boxes()) {
    for (int i = 2; i < box_corners; ++i) mobile[at(box.first_vertex + i)] = 0;
  }
  return mobile;
}

double max_way(const VertexArray& values) {
  return std::sqrt(values.rows().colwise().squaredNorm().maxCoeff());
}

}  // namespace

WorldMinimiser::WorldMinimiser(const ContactSurfaces& surfaces, const WorldEnergy& energy)
    : surfaces_(surfaces),
      energy_(energy),
      kept_(surfaces),
      matrix_(mobile_coordinates(surfaces, energy)),
      point_(energy.make_point()),
      trial_(energy.make_point()),
      gradient_(surfaces.vertex_count()),
      right_(surfaces.vertex_count()),
      direction_(surfaces.vertex_count()),
      given_(surfaces.vertex_count()),
      ahead_(surfaces.vertex_count()) {
  for (const ContactSurface& surface : surfaces_.all()) {
    greatest_reach_ = std::max(greatest_reach_, surface.reach);
  }
}

void WorldMinimiser::find_pairs(const VertexArray& from, const VertexArray& to, double beside) {
  const double around =
      std::clamp(way_around * max_distance(from, to), least_reaches_around * greatest_reach_,
                 most_reaches_around * greatest_reach_);
  kept_.find(from, to, beside + around);
}

const std::vector<ContactPair>& WorldMinimiser::pairs_at(const VertexArray& positions) {
  if (!kept_.cover(positions)) find_pairs(positions, positions);
  return kept_.pairs();
}

/// Also on the way from the point, where it bends by `beside` (m) at most.
const std::vector<ContactPair>& WorldMinimiser::pairs_to(const VertexArray& ahead, double beside) {
  if (!kept_.cover(point_.positions, beside) || !kept_.cover(ahead, beside)) {
    find_pairs(point_.positions, ahead, beside);
  }
  return kept_.pairs();
}

bool WorldMinimiser::begin() { return energy_.evaluate(pairs_at(point_.positions), point_); }

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
  energy_.hessian(point_, is_whole ? ContactHessian::whole : ContactHessian::along_normals,
                  lagged_form_, matrix_);
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
    const WorldMatrix::End end = matrix_.solve(right_, shift_, forcing_, direction_);
    has_negative_curvature_ = end == WorldMatrix::End::negative_curvature;
    if (end != WorldMatrix::End::not_positive) break;
    shift_ = std::max(world_shift_factor * shift_, first_world_shift * energy_.inertia());
  }
  direction_.rows() += given_.rows();
}

/// rad, of the direction.
double WorldMinimiser::max_turn() const {
  double most = 0.0;
  for (const WorldEnergy::Box& box : energy_.boxes()) {
    most = std::max(most, direction_[box.first_vertex + 1].norm());
  }
  return most;
}

/// Along the direction.
void WorldMinimiser::go(double fraction, WorldPoint& to) const {
  to.positions.rows() = point_.positions.rows() + fraction * direction_.rows();
  for (std::size_t i = 0; i < to.boxes.size(); ++i) {
    const int first = energy_.boxes()[i].first_vertex;
    to.boxes[i].position = point_.boxes[i].position + fraction * direction_[first];
    to.boxes[i].orientation = turned(point_.boxes[i].orientation, fraction * direction_[first + 1]);
  }
  energy_.place_boxes(to);
}

/// At most the given one: the trial is put to where nothing stands between.
double WorldMinimiser::allowed_fraction(double fraction) {
  for (int i = 0; i < max_besides; ++i) {
    go(fraction, trial_);
    const WayLimit limit =
        limit_ways(surfaces_, kept_.pairs(), point_.positions, trial_.positions, kept_beside);
    if (!limit.is_limited) return fraction;
    fraction *= std::min(shortened, limit.fraction);
  }
  return 0.0;
}

/// m, by which the ways of corners bend away from straight ones.
double WorldMinimiser::margin_beside(double turn) const {
  if (turn == 0.0) return 0.0;
  double farthest = 0.0;
  for (std::size_t i = 0; i < point_.boxes.size(); ++i) {
    const Vec3 corner = point_.positions[energy_.boxes()[i].first_vertex];
    farthest = std::max(farthest, (corner - point_.boxes[i].position).norm());
  }
  return farthest * (1.0 - std::cos(0.5 * turn));
}

/// Of a direction by which vertices move by `size` (m) and boxes turn by `turn` at most.
double WorldMinimiser::longest_fraction(double turn, double size) const {
  double longest = turn > max_turn_per_iteration ? max_turn_per_iteration / turn : 1.0;
  if (has_negative_curvature_) longest = std::min(longest, max_growth * last_way_ / size);
  return longest;
}

/// Returns the fraction of the direction that was taken; 0 when none helped.
double WorldMinimiser::search_line(bool arrived, double size, WorldMinimiserReport& report) {
  const double turn = max_turn(), longest = longest_fraction(turn, size);
  go(longest, trial_);
  ahead_.rows() = trial_.positions.rows();
  const std::vector<ContactPair>& pairs = pairs_to(ahead_, margin_beside(longest * turn));
  const WayLimit limit = limit_ways(surfaces_, pairs, point_.positions, ahead_, kept_distance);
  report.blocked = limit;
  if (limit.pair >= 0) report.blocked_pair = pairs[at(limit.pair)];
  free_fraction_ = longest * limit.fraction;
  double fraction = free_fraction_;
  for (int i = 0; i <= max_world_halvings; ++i, fraction *= 0.5) {
    if (turn > 0.0 && fraction < longest) {
      fraction = allowed_fraction(fraction);
    } else {
      go(fraction, trial_);
    }
    for (int v = 0; fraction == 1.0 && v < given_.size(); ++v) {
      if (!surfaces_.is_mobile(v)) trial_.positions[v] = energy_.targets()[v];
    }
    if (!energy_.evaluate(pairs, trial_)) continue;
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
  forcing_ = max_forcing;
  last_way_ = greatest_reach_;
  lagged_form_ = LaggedTerms::Form::derivative;
  double last_size = std::numeric_limits<double>::infinity();
  double last_promise = 0.0;
  int polishing = 0, blocked = 0;
  bool arrived = is_arrived();
  while (report.iterations < max_world_iterations && !report.converged) {
    const double forcing = forcing_;
    find_direction(report.iterations);
    ++report.iterations;
    right_.rows() = direction_.rows();
    expand(matrix_.frames(), right_);
    const double size = max_way(right_);
    const double promise = -dot(gradient_, direction_);
    const double fraction = search_line(arrived, size, report);
    last_way_ = fraction * size;
    if (last_promise > 0.0) {
      forcing_ = std::clamp(forcing_factor * promise / last_promise, min_forcing, max_forcing);
    }
    last_promise = promise;
    if (!arrived) {
      if (fraction < least_progress && ++blocked >= max_blocked) break;
      if (report.iterations >= max_arrival_iterations) break;
      arrived = is_arrived();
      last_size = 0.0;
      continue;
    }
    if (!(promise > world_energy_rounding * point_.magnitude)) ++polishing;
    const bool full = fraction == 1.0 && shift_ == 0.0;
    const double shrinking =
        full && last_size > 0.0 && std::isfinite(last_size)
            ? std::clamp(size / last_size, std::max(min_shrinking, forcing), 1.0)
            : 1.0;
    report.converged =
        (size * shrinking <= tolerance && promise <= small_world_promise * energy_.gas_scale()) ||
        fraction == 0.0 || polishing > max_world_polishing;
    last_size = full ? size : 0.0;
    shift_ /= world_shift_factor;
    const bool is_halved = fraction < halved_fraction * free_fraction_;
    const bool is_long = size > long_way * energy_.lagged_length();
    const bool is_bounding = is_halved || lagged_form_ == LaggedTerms::Form::bounding;
    lagged_form_ =
        is_bounding && is_long ? LaggedTerms::Form::bounding : LaggedTerms::Form::derivative;
  }
  report.arrived = arrived;
  return report;
}

}  // namespace pneuma::sim

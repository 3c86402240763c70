#include "sim/soft/euler_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "sim/mesh/measure.h"
#include "sim/soft/damping.h"
#include "sim/soft/pressure_force.h"

namespace pneuma::sim {
namespace {

using Vec2 = Eigen::Vector2d;

bool has_hinge_dashpots(const SoftMesh& mesh, const SoftMaterial& material) {
  return mesh.hinges && material.bending > 0.0 && material.bending_damping > 0.0;
}

/// Fraction of the mean rest length: how far from the minimum a vertex may end.
constexpr double tolerance_fraction = 1e-10;
/// Fraction of the largest coordinate: what a double can resolve.
constexpr double rounding_fraction = 4e-15;

/// m/s. Slower vertices are taken to stick to their friction anchors, until it is known better.
constexpr double anchor_speed = 1e-4;
/// Friction comes from the ground's forces, which it changes in turn: the minimisation is repeated
/// until no vertex begins or ceases to slide, and the friction of those that do changes by less
/// than this fraction in all, but not more often than this.
constexpr double friction_bound_change = 0.05;
constexpr int max_friction_rounds = 4;

}  // namespace

Deformation::Deformation(const SoftMesh& mesh) : lengths(mesh.rest_lengths.size()) {
  if (mesh.hinges) hinges.reserve(mesh.rest_lengths.size());
}

void measure(const SoftMesh& mesh, const SoftMaterial& material, const VertexArray& positions,
             Deformation& deformation) {
  const auto& x = positions.rows();
  for (std::size_t e = 0; e < deformation.lengths.size(); ++e) {
    const auto& [a, b] = mesh.topology.edges()[e];
    deformation.lengths[e] = (x.col(b) - x.col(a)).norm();
  }
  deformation.hinges.clear();
  if (has_hinge_dashpots(mesh, material)) {
    hinge_states(*mesh.hinges, positions, deformation.hinges);
  }
}

void extrapolate(const Deformation& from, double factor, Deformation& to) {
  for (std::size_t e = 0; e < to.lengths.size(); ++e) {
    to.lengths[e] = from.lengths[e] + factor * (to.lengths[e] - from.lengths[e]);
  }
  for (std::size_t e = 0; e < to.hinges.size(); ++e) {
    const HingeState &a = from.hinges[e], &b = to.hinges[e];
    const double start = std::atan2(a.angle.sine, a.angle.cosine);
    const double turned = std::atan2(b.angle.sine * a.angle.cosine - b.angle.cosine * a.angle.sine,
                                     b.angle.cosine * a.angle.cosine + b.angle.sine * a.angle.sine);
    const double angle = start + factor * turned;
    to.hinges[e] = {{std::cos(angle), std::sin(angle)}, a.dashpot_fraction};
  }
}

EulerBase::EulerBase(const SoftMesh& mesh)
    : state{VertexArray(mesh.topology.vertex_count()), VertexArray(mesh.topology.vertex_count())},
      deformation(mesh) {}

EulerSolver::EulerSolver(const SoftMesh& mesh)
    : mesh_(mesh),
      minimiser_(mesh),
      energy_(mesh),
      positions_(mesh.topology.vertex_count()),
      mean_rest_length_(std::accumulate(mesh.rest_lengths.begin(), mesh.rest_lengths.end(), 0.0) /
                        static_cast<double>(mesh.rest_lengths.size())) {}

void EulerSolver::set_body(const SoftMaterial& material, const Vec3& gravity, double friction) {
  material_ = material;
  gravity_ = gravity;
  friction_ = friction;
  effort_ = {};
  minimiser_.forget();
}

void EulerSolver::set_floor(int vertex, double height) {
  energy_.ground = true;
  energy_.floor[at(vertex)] = height;
}

void EulerSolver::set_pins(const Pins* pins) {
  energy_.is_pinned = pins ? pins->is_pinned.data() : nullptr;
  for (int v = 0; has_pins() && v < positions_.size(); ++v) {
    if (is_pinned(energy_, v)) energy_.floor[at(v)] = -std::numeric_limits<double>::infinity();
  }
}

bool EulerSolver::step(double beta, const EulerBase& base, const VertexArray& guess) {
  set_energy(beta, base);
  const double tolerance = std::max(tolerance_fraction * mean_rest_length_,
                                    rounding_fraction * guess.rows().cwiseAbs().maxCoeff());
  if (!begin(guess, false)) return false;
  predict_friction(base);
  for (int round = 1;; ++round) {
    if (energy_.friction && !begin(guess, true)) return false;
    const MinimiserReport report = minimiser_.minimise(energy_, tolerance);
    effort_.iterations += report.iterations;
    effort_.factorizations += report.factorizations;
    effort_.converged &= report.converged;
    minimiser_.update_gradient(energy_);
    if (!report.converged || round == max_friction_rounds || !correct_friction()) break;
  }
  positions_.rows() = minimiser_.point().positions.rows();
  keep_momentum();
  return true;
}

void set_step_energy(const SoftMesh& mesh, const SoftMaterial& material, const Vec3& gravity,
                     double beta, const EulerBase& base, IncrementalPotential& energy) {
  const double slowing = 1.0 + drag_rate(material) * beta;
  energy.inertia = material.vertex_mass * slowing / (beta * beta);
  energy.target.rows() =
      base.state.positions.rows() + beta / slowing * base.state.velocities.rows();
  const Vec3 fall = beta * beta / slowing * gravity;
  for (int v = 0; v < energy.target.size(); ++v) energy.target[v] += fall;
  for (int v = 0; energy.is_pinned != nullptr && v < energy.target.size(); ++v) {
    if (!is_pinned(energy, v)) continue;
    energy.target[v] = base.state.positions[v] + beta * base.state.velocities[v];
  }

  const double dashpot = dashpot_constant(material) / beta;
  energy.stiffness = material.k + dashpot;
  const double dashpot_fraction = energy.stiffness > 0.0 ? dashpot / energy.stiffness : 0.0;
  for (std::size_t e = 0; e < energy.rest_lengths.size(); ++e) {
    energy.rest_lengths[e] = (1.0 - dashpot_fraction) * mesh.rest_lengths[e] +
                             dashpot_fraction * base.deformation.lengths[e];
  }
  energy.bending = material.bending;
  if (has_hinge_dashpots(mesh, material)) {
    join_dashpots(*mesh.hinges, base.deformation.hinges, material.bending_damping / beta,
                  energy.hinges);
  } else if (mesh.hinges) {
    energy.hinges.weights = mesh.hinges->weights;
    energy.hinges.rest = mesh.hinges->rest;
  }
  energy.gas = gas_law(material);
}

void EulerSolver::set_energy(double beta, const EulerBase& base) {
  set_step_energy(mesh_, material_, gravity_, beta, base, energy_);
  energy_.friction_anchor.rows() = base.state.positions.rows();
  energy_.regularisation_length = anchor_speed * beta;
  energy_.friction = false;
}

/// Starts the minimiser from the best of some positions: the guess, the guess moved along as a
/// whole, where the vertices would be by themselves, and, if asked to, where it is.
bool EulerSolver::begin(const VertexArray& guess, bool from_here) {
  EnergyPoint& point = minimiser_.point();
  double min_energy = std::numeric_limits<double>::infinity();
  const auto consider = [&] {
    put_where_allowed(point.positions);
    if (!evaluate(mesh_, energy_, point) || !(point.energy < min_energy)) return;
    min_energy = point.energy;
    positions_.rows() = point.positions.rows();
  };
  if (from_here) consider();
  point.positions.rows() = guess.rows();
  consider();
  const Vec3 move = mean(energy_.target) - mean(guess);
  for (int v = 0; v < guess.size(); ++v) point.positions[v] += move;
  consider();
  point.positions.rows() = energy_.target.rows();
  consider();
  point.positions.rows() = positions_.rows();
  return std::isfinite(min_energy) && evaluate(mesh_, energy_, point);
}

void EulerSolver::put_where_allowed(VertexArray& positions) const {
  for (int v = 0; has_pins() && v < positions.size(); ++v) {
    if (is_pinned(energy_, v)) positions[v] = energy_.target[v];
  }
  if (!energy_.ground) return;
  for (int v = 0; v < positions.size(); ++v) {
    positions[v].z() = std::max(positions[v].z(), energy_.floor[at(v)]);
    if (!energy_.friction || !energy_.anchored[at(v)]) continue;
    positions[v].head<2>() = Vec3(energy_.friction_anchor[v]).head<2>();
  }
}

/// From where the minimiser is: what the ground pushes there sticks if it was slow, or slides.
void EulerSolver::predict_friction(const EulerBase& base) {
  if (!energy_.ground || friction_ == 0.0) return;
  minimiser_.update_gradient(energy_);
  for (int v = 0; v < positions_.size(); ++v) {
    const double bound = friction_ * normal_force(v);
    const bool slow = Vec3(base.state.velocities[v]).head<2>().norm() < anchor_speed;
    energy_.anchored[at(v)] = bound > 0.0 && slow;
    energy_.friction_bound[at(v)] = slow ? 0.0 : bound;
    energy_.friction |= bound > 0.0;
  }
}

/// From where the minimiser has come to. Returns whether that must be minimised again.
bool EulerSolver::correct_friction() {
  if (!energy_.ground || friction_ == 0.0) return false;
  double change = 0.0, sum = 0.0;
  bool other = false;  // anchored or not
  for (int v = 0; v < positions_.size(); ++v) {
    const double bound = friction_ * normal_force(v);
    const Vec3 slide = minimiser_.point().positions[v] - energy_.friction_anchor[v];
    const bool was_anchored = energy_.friction && energy_.anchored[at(v)];
    const bool is_anchored =
        bound > 0.0 && (was_anchored ? minimiser_.anchor_force(v) <= bound
                                     : slide.head<2>().norm() < energy_.regularisation_length);
    const double before = energy_.friction ? energy_.friction_bound[at(v)] : 0.0;
    energy_.anchored[at(v)] = is_anchored;
    energy_.friction_bound[at(v)] = is_anchored ? 0.0 : bound;
    change += std::abs(energy_.friction_bound[at(v)] - before);
    sum += bound;
    other |= is_anchored != was_anchored;
  }
  energy_.friction = sum > 0.0;
  return other || change > friction_bound_change * sum;
}

/// Springs and gas do not move the centre, unless something holds the body: what is left of that,
/// in the air, is the minimisation's tolerance.
void EulerSolver::keep_momentum() {
  if (has_pins()) return;
  const Vec3 move = mean(energy_.target) - mean(positions_);
  for (int v = 0; energy_.ground && v < positions_.size(); ++v) {
    if (normal_force(v) > 0.0) return;
    if (positions_[v].z() + move.z() < energy_.floor[at(v)]) return;
  }
  for (int v = 0; v < positions_.size(); ++v) positions_[v] += move;
}

}  // namespace pneuma::sim

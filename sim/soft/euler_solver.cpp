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

/// Of the mean rest length: how far from the least energy a vertex may end.
constexpr double tolerance_share = 1e-10;
/// Of the greatest coordinate: what a double can tell.
constexpr double rounding_share = 4e-15;

/// m/s. While the minimisation goes on, a vertex that friction holds may slide as fast; then it is
/// put back.
constexpr double slip_speed = 1e-4;
/// Friction's grip comes from the ground's forces, which it changes in turn: the minimisation is
/// repeated until the changes add up to less than this share of them, but not more often than this.
constexpr double grip_change = 0.05;
constexpr int greatest_grip_rounds = 3;

}  // namespace

void edge_lengths(const MeshTopology& topology, const VertexArray& positions,
                  std::vector<double>& lengths) {
  const auto& x = positions.rows();
  for (std::size_t e = 0; e < lengths.size(); ++e) {
    const auto& [a, b] = topology.edges()[e];
    lengths[e] = (x.col(b) - x.col(a)).norm();
  }
}

EulerBase::EulerBase(const SoftMesh& mesh)
    : state{VertexArray(mesh.topology.vertex_count()), VertexArray(mesh.topology.vertex_count())},
      lengths(mesh.rest_lengths.size()) {}

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

void EulerSolver::step(double beta, const EulerBase& base, const VertexArray& guess) {
  set_energy(beta, base);
  const double tolerance = std::max(tolerance_share * mean_rest_length_,
                                    rounding_share * guess.rows().cwiseAbs().maxCoeff());
  begin(guess, false);
  for (int round = 1;; ++round) {
    if (set_grip()) begin(guess, true);
    const MinimiserReport report = minimiser_.minimise(energy_, tolerance);
    effort_.iterations += report.iterations;
    effort_.factorizations += report.factorizations;
    effort_.converged &= report.converged;
    minimiser_.update_gradient(energy_);
    if (round == greatest_grip_rounds || !grip_has_changed()) break;
  }
  finish();
}

void EulerSolver::set_energy(double beta, const EulerBase& base) {
  const double slowing = 1.0 + drag_rate(material_) * beta;
  energy_.inertia = material_.vertex_mass * slowing / (beta * beta);
  energy_.target.rows() =
      base.state.positions.rows() + beta / slowing * base.state.velocities.rows();
  const Vec3 fall = beta * beta / slowing * gravity_;
  for (int v = 0; v < energy_.target.size(); ++v) energy_.target[v] += fall;

  const double dashpot = dashpot_constant(material_) / beta;
  energy_.stiffness = material_.k + dashpot;
  const double share = energy_.stiffness > 0.0 ? dashpot / energy_.stiffness : 0.0;
  for (std::size_t e = 0; e < energy_.rest_lengths.size(); ++e) {
    energy_.rest_lengths[e] = (1.0 - share) * mesh_.rest_lengths[e] + share * base.lengths[e];
  }

  energy_.gas = gas_strength(material_);
  energy_.hold.rows() = base.state.positions.rows();
  energy_.slip = slip_speed * beta;
  energy_.friction = false;
  std::fill(energy_.grip.begin(), energy_.grip.end(), 0.0);
}

/// Takes the minimiser to the best of some places: the guess, the guess moved along as a whole,
/// where the vertices would be by themselves, and, if asked to, where it is.
void EulerSolver::begin(const VertexArray& guess, bool from_here) {
  EnergyPoint& point = minimiser_.point();
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&] {
    raise_to_floor(point.positions);
    if (!evaluate(mesh_, energy_, point) || !(point.energy < least)) return;
    least = point.energy;
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
  evaluate(mesh_, energy_, point);
}

void EulerSolver::raise_to_floor(VertexArray& positions) const {
  if (!energy_.ground) return;
  for (int v = 0; v < positions.size(); ++v) {
    positions[v].z() = std::max(positions[v].z(), energy_.floor[at(v)]);
  }
}

/// From the ground's forces where the minimiser is. Returns whether there is any.
bool EulerSolver::set_grip() {
  if (!energy_.ground || friction_ == 0.0) return false;
  minimiser_.update_gradient(energy_);
  energy_.friction = false;
  for (int v = 0; v < positions_.size(); ++v) {
    energy_.grip[at(v)] = friction_ * normal_force(v);
    energy_.friction |= energy_.grip[at(v)] > 0.0;
  }
  return energy_.friction;
}

bool EulerSolver::grip_has_changed() const {
  if (!energy_.ground || friction_ == 0.0) return false;
  double change = 0.0, sum = 0.0;
  for (int v = 0; v < positions_.size(); ++v) {
    const double grip = friction_ * normal_force(v);
    change += std::abs(grip - energy_.grip[at(v)]);
    sum += grip;
  }
  return change > grip_change * sum;
}

bool EulerSolver::is_on_floor(int vertex) const {
  return energy_.ground && positions_[vertex].z() <= energy_.floor[at(vertex)];
}

Vec3 EulerSolver::ground_force(int vertex) const {
  if (!energy_.ground) return Vec3::Zero();
  const double normal = normal_force(vertex);
  // The grip is that of the last round but one: not more than Coulomb's law allows in the end.
  const double grip = std::min(energy_.grip[at(vertex)], friction_ * normal);
  const VertexArray& x = minimiser_.point().positions;
  const Vec2 slide = (x[vertex] - energy_.hold[vertex]).head<2>();
  const Vec2 sideways = -grip / std::max(slide.norm(), energy_.slip) * slide;
  return {sideways.x(), sideways.y(), normal};
}

void EulerSolver::finish() {
  positions_.rows() = minimiser_.point().positions.rows();
  bool touches = false;
  for (int v = 0; v < positions_.size(); ++v) touches |= energy_.ground && normal_force(v) > 0.0;
  if (touches) {
    hold_still_vertices();
    return;
  }
  // Springs and gas do not move the centre: what is left of that is the minimisation's tolerance.
  const Vec3 move = mean(energy_.target) - mean(positions_);
  for (int v = 0; v < positions_.size(); ++v) positions_[v] += move;
}

void EulerSolver::hold_still_vertices() {
  if (!energy_.friction) return;
  for (int v = 0; v < positions_.size(); ++v) {
    if (energy_.grip[at(v)] == 0.0) continue;
    const Vec3 hold = energy_.hold[v];
    if ((positions_[v] - hold).head<2>().norm() >= energy_.slip) continue;
    positions_[v].head<2>() = hold.head<2>();
  }
  // A body that is flat to within a micrometre.
  if (energy_.gas > 0.0 && !(volume(mesh_.topology, positions_) > 0.0)) {
    positions_.rows() = minimiser_.point().positions.rows();
  }
}

}  // namespace pneuma::sim

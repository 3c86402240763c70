#include "sim/swept/newton_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/mesh/rotation.h"

namespace pneuma::sim {
namespace {

constexpr int max_steps = 10;
/// Of a step along its line, and the slope at its end as a fraction of that at its start.
constexpr int max_trials = 8;
constexpr double flat = 0.1;
/// Of the squared residual: below it lies rounding times the penalty.
constexpr double converged = 1e-12;
/// Multiplications of a factorisation. A stack of some hundred boxes has fewer, a heap of 50 more.
constexpr double most_work = 1e5;
/// In place of its work: of a heap with so many impulses it is greater.
constexpr std::size_t most_impulses = 1000;

Mat3 inertia_of(const BoxChange& box) {
  Mat3 inverse;
  for (int k = 0; k < 3; ++k) inverse.col(k) = to_vec3(box.inverse_inertia.columns[at(k)]);
  return inverse.inverse();
}

double mass(const ContactNode& node) {
  return node.box ? 1.0 / node.box->inverse_mass : node.vertex_mass;
}

Vec3 part(std::span<const double> unknowns, int first) {
  return Vec3::Map(unknowns.data() + first);
}

/// The lever's velocity from the unknowns of its node, of which a vertex has the first three.
LeverJacobian jacobian(const ContactLever& lever) {
  LeverJacobian result;
  result << lever.weight * Mat3::Identity(), -lever.weight * cross_matrix(lever.arm);
  return result;
}

}  // namespace

bool NewtonSolver::begin(std::span<SweptImpulse* const> impulses) {
  if (impulses.size() > most_impulses) return false;
  impulses_ = impulses;
  nodes_.find(impulses);
  if (!is_small()) return false;
  inertias_.clear();
  for (const ContactNode& node : nodes_.nodes()) {
    inertias_.push_back(node.box ? inertia_of(*node.box) : Mat3::Zero());
  }
  jacobians_.clear();
  for (const ContactLever& lever : nodes_.levers()) jacobians_.push_back(jacobian(lever));
  return true;
}

bool NewtonSolver::improve(double penalty) {
  read_velocities();
  respond(penalty);
  double at_first = 0.0;
  for (int step = 0; step < max_steps; ++step) {
    assemble();
    double squared = 0.0;
    for (const double r : residual_) squared += r * r;
    if (step == 0) at_first = squared;
    if (squared <= converged * at_first) {
      for (std::size_t i = 0; i < impulses_.size(); ++i) {
        impulses_[i]->replace_given(responses_[i].given);
      }
      return true;
    }
    if (!matrix_.factor()) return false;
    matrix_.solve(residual_);
    if (!descend(penalty)) return false;
  }
  return false;
}

bool NewtonSolver::is_small() {
  nodes_.first_columns(first_columns_);
  double work = 0.0;
  for (std::size_t row = 0; row < first_columns_.size(); ++row) {
    const double width = static_cast<double>(row) - first_columns_[row];
    work += 0.5 * width * width;
  }
  return work <= most_work;
}

void NewtonSolver::read_velocities() {
  velocities_.resize(at(nodes_.rows()));
  for (const ContactNode& node : nodes_.nodes()) {
    double* const v = velocities_.data() + node.row;
    for (int k = 0; k < 3; ++k) v[k] = node.box ? node.box->velocity[k] : node.vertex[k];
    if (!node.box) continue;
    for (int k = 0; k < 3; ++k) v[3 + k] = node.box->angular_velocity[k];
  }
}

Vec4d NewtonSolver::relative(std::span<const ContactLever> levers,
                             std::span<const double> unknowns) const {
  Vec3 sum = Vec3::Zero();
  for (const ContactLever& lever : levers) {
    const ContactNode& node = nodes_.nodes()[at(lever.node)];
    sum += lever.weight * part(unknowns, node.row);
    if (node.box) sum += lever.weight * part(unknowns, node.row + 3).cross(lever.arm);
  }
  return to_vec4d(sum);
}

void NewtonSolver::respond(double penalty) {
  changes_.clear();
  responses_.clear();
  for (std::size_t i = 0; i < impulses_.size(); ++i) {
    changes_.push_back(relative(nodes_.levers(i), velocities_));
    responses_.push_back(impulses_[i]->respond(changes_.back(), penalty));
  }
}

void NewtonSolver::assemble() {
  matrix_.reset(first_columns_);
  residual_.assign(at(nodes_.rows()), 0.0);
  add_masses();
  for (std::size_t i = 0; i < impulses_.size(); ++i) {
    const auto levers = nodes_.levers(i);
    add(responses_[i], levers, std::span(jacobians_).subspan(nodes_.first_lever(i), levers.size()));
  }
}

void NewtonSolver::add_masses() {
  for (std::size_t i = 0; i < nodes_.nodes().size(); ++i) {
    const ContactNode& node = nodes_.nodes()[i];
    for (int k = 0; k < 3; ++k) matrix_.entry(node.row + k, node.row + k) += mass(node);
    Vec3::Map(residual_.data() + node.row) -= mass(node) * part(velocities_, node.row);
    if (!node.box) continue;
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l <= k; ++l) {
        matrix_.entry(node.row + 3 + k, node.row + 3 + l) += inertias_[i](k, l);
      }
    }
    Vec3::Map(residual_.data() + node.row + 3) -= inertias_[i] * part(velocities_, node.row + 3);
  }
}

void NewtonSolver::add(const SweptImpulse::Response& response, std::span<const ContactLever> levers,
                       std::span<const LeverJacobian> jacobians) {
  for (std::size_t a = 0; a < levers.size(); ++a) {
    const ContactNode& one = nodes_.nodes()[at(levers[a].node)];
    const Eigen::Matrix<double, 6, 3> to_node = jacobians[a].transpose();
    const Eigen::Matrix<double, 6, 1> force = to_node * to_vec3(response.given);
    for (int k = 0; k < one.rows(); ++k) residual_[at(one.row + k)] += force[k];
    const Eigen::Matrix<double, 6, 3> stiffness = to_node * response.stiffness;
    for (std::size_t b = 0; b < levers.size(); ++b) {
      const ContactNode& other = nodes_.nodes()[at(levers[b].node)];
      if (other.row > one.row) continue;
      const Eigen::Matrix<double, 6, 6> block = stiffness * jacobians[b];
      for (int k = 0; k < one.rows(); ++k) {
        const int end = std::min(other.rows(), one.row + k - other.row + 1);
        double* const entries = &matrix_.entry(one.row + k, other.row);
        for (int l = 0; l < end; ++l) entries[l] += block(k, l);
      }
    }
  }
}

double NewtonSolver::product(std::span<const double> one, std::span<const double> other) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < nodes_.nodes().size(); ++i) {
    const ContactNode& node = nodes_.nodes()[i];
    sum += mass(node) * part(one, node.row).dot(part(other, node.row));
    if (node.box) sum += part(one, node.row + 3).dot(inertias_[i] * part(other, node.row + 3));
  }
  return sum;
}

NewtonSolver::Slope NewtonSolver::respond_along(double fraction, double penalty) {
  Slope slope{by_velocity_ + fraction * by_step_, by_step_};
  for (std::size_t i = 0; i < impulses_.size(); ++i) {
    responses_[i] = impulses_[i]->respond(changes_[i] + fraction * ways_[i], penalty);
    slope.value -= dot(responses_[i].given, ways_[i]);
    const Vec3 way = to_vec3(ways_[i]);
    slope.growth += way.dot(responses_[i].stiffness * way);
  }
  return slope;
}

/// Where the slope, which grows along the step, is nearly zero: by Newton's method within the
/// bounds that are known.
bool NewtonSolver::descend(double penalty) {
  by_velocity_ = product(velocities_, residual_);
  by_step_ = product(residual_, residual_);
  double before = by_velocity_;
  ways_.clear();
  for (std::size_t i = 0; i < impulses_.size(); ++i) {
    ways_.push_back(relative(nodes_.levers(i), residual_));
    before -= dot(responses_[i].given, ways_[i]);
  }
  if (!(before < 0.0)) return false;
  double fraction = 1.0, low = 0.0, high = std::numeric_limits<double>::infinity();
  for (int trial = 0;; ++trial) {
    const Slope slope = respond_along(fraction, penalty);
    if (std::abs(slope.value) <= -flat * before || trial == max_trials) break;
    (slope.value < 0.0 ? low : high) = fraction;
    const double next = fraction - slope.value / slope.growth;
    const double between = std::isinf(high) ? 2.0 * low : 0.5 * (low + high);
    fraction = next > low && next < high ? next : between;
  }
  for (std::size_t i = 0; i < velocities_.size(); ++i) velocities_[i] += fraction * residual_[i];
  for (std::size_t i = 0; i < changes_.size(); ++i) changes_[i] += fraction * ways_[i];
  return true;
}

}  // namespace pneuma::sim

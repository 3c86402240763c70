#include "sim/swept/newton_solver.h"

#include <algorithm>

#include "sim/mesh/rotation.h"

namespace pneuma::sim {
namespace {

constexpr int max_steps = 10;
constexpr int max_shortenings = 12;
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
  double potential = respond(penalty), at_first = 0.0;
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
    if (!descend(penalty, potential)) return false;
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

Vec3 NewtonSolver::part(const ContactNode& node, int first) const {
  return Vec3::Map(velocities_.data() + node.row + first);
}

Vec4d NewtonSolver::relative_change(std::span<const ContactLever> levers) const {
  Vec3 sum = Vec3::Zero();
  for (const ContactLever& lever : levers) {
    const ContactNode& node = nodes_.nodes()[at(lever.node)];
    sum += lever.weight * part(node, 0);
    if (node.box) sum += lever.weight * part(node, 3).cross(lever.arm);
  }
  return to_vec4d(sum);
}

double NewtonSolver::respond(double penalty) {
  double sum = 0.0;
  for (std::size_t i = 0; i < nodes_.nodes().size(); ++i) {
    const ContactNode& node = nodes_.nodes()[i];
    const double mass = node.box ? 1.0 / node.box->inverse_mass : node.vertex_mass;
    sum += 0.5 * mass * part(node, 0).squaredNorm();
    if (node.box) sum += 0.5 * part(node, 3).dot(inertias_[i] * part(node, 3));
  }
  responses_.resize(impulses_.size());
  for (std::size_t i = 0; i < impulses_.size(); ++i) {
    responses_[i] = impulses_[i]->respond(relative_change(nodes_.levers(i)), penalty);
    sum += responses_[i].potential;
  }
  return sum;
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
    const double mass = node.box ? 1.0 / node.box->inverse_mass : node.vertex_mass;
    for (int k = 0; k < 3; ++k) matrix_.entry(node.row + k, node.row + k) += mass;
    Vec3::Map(residual_.data() + node.row) -= mass * part(node, 0);
    if (!node.box) continue;
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l <= k; ++l) {
        matrix_.entry(node.row + 3 + k, node.row + 3 + l) += inertias_[i](k, l);
      }
    }
    Vec3::Map(residual_.data() + node.row + 3) -= inertias_[i] * part(node, 3);
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

void NewtonSolver::move(double fraction) {
  for (std::size_t i = 0; i < velocities_.size(); ++i) velocities_[i] += fraction * residual_[i];
}

/// The longest of the step, its half, its quarter and so on that the potential falls by.
bool NewtonSolver::descend(double penalty, double& potential) {
  const double before = potential;
  move(1.0);
  double fraction = 1.0;
  for (int i = 0; i < max_shortenings; ++i) {
    potential = respond(penalty);
    if (potential < before) return true;
    move(-0.5 * fraction);
    fraction *= 0.5;
  }
  return false;
}

}  // namespace pneuma::sim

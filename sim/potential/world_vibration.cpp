#include "sim/potential/world_vibration.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/base/max_eigenvector.h"
#include "sim/potential/near_pairs.h"
#include "sim/rigid/inertia.h"

namespace pneuma::sim {
namespace {

using Eigen::VectorXd;

/// s: of a step so long that springs, gas and contacts alone are left of its second derivative,
/// M / beta^2 + D / beta + K.
constexpr double longest_step = 1e6;
/// s: of one in which dashpots count for as much as springs do in most bodies.
constexpr double damped_step = 1e-3;

/// Their drag is no dashpot, but a fraction of their motion in a time.
World without_drag_of_boxes(World world) {
  for (RigidBox& box : world.rigid) box.rho_g = 0.0;
  return world;
}

}  // namespace

WorldVibration::WorldVibration(const World& world)
    : world_(without_drag_of_boxes(world)),
      surfaces_(world_),
      energy_(world_, surfaces_),
      point_(energy_.make_point()),
      still_(surfaces_.vertex_count()),
      matrix_(surfaces_.mobile()),
      values_(surfaces_.vertex_count()),
      product_(surfaces_.vertex_count()) {
  surfaces_.gather(world_, point_.positions, still_);
  surfaces_.place_boxes(world_, point_.positions);
  still_.rows().setZero();
  for (const WorldEnergy::Body& body : energy_.bodies()) {
    const SoftBody& soft = world_.soft[at(body.soft)];
    EulerBase& base = bases_.emplace_back(*body.mesh);
    base.state = {soft.positions, VertexArray(soft.positions.size())};
    measure(*body.mesh, soft.material, base.state.positions, base.deformation);
  }
  for (std::size_t i = 0; i < energy_.boxes().size(); ++i) {
    const RigidBox& box = world_.rigid[at(energy_.boxes()[i].index)];
    box_bases_.push_back({box.position, box.orientation, Vec3::Zero(), Vec3::Zero()});
    point_.boxes[i] = {box.position, box.orientation};
  }
  find_masses();
  std::vector<ContactPair> pairs;
  PairFinder(surfaces_).find(point_.positions, point_.positions, 0.0, pairs);
  energy_.set_step(world_, longest_step, bases_, box_bases_, point_.positions);
  if (!energy_.evaluate(pairs, point_)) {
    throw std::invalid_argument("bodies are in each other or inside out");
  }
}

void WorldVibration::find_masses() {
  inverse_root_.assign(at(surfaces_.vertex_count()), 0.0);
  for (const WorldEnergy::Body& body : energy_.bodies()) {
    const SoftBody& soft = world_.soft[at(body.soft)];
    for (int v = 0; v < soft.positions.size(); ++v) {
      const int vertex = body.first_vertex + v;
      if (!surfaces_.is_mobile(vertex)) continue;
      inverse_root_[at(vertex)] = 1.0 / std::sqrt(soft.material.vertex_mass);
    }
  }
  for (const WorldEnergy::Box& box : energy_.boxes()) {
    const RigidBox& rigid = world_.rigid[at(box.index)];
    inverse_root_[at(box.first_vertex)] = 1.0 / std::sqrt(rigid.mass);
    inverse_root_[at(box.first_vertex + 1)] = 1.0;  // besides of_turns_
    const Mat3 turn = rigid.orientation.toRotationMatrix();
    of_turns_.emplace_back(turn * body_inertia(rigid).cwiseSqrt().cwiseInverse().asDiagonal() *
                           turn.transpose());
  }
}

void WorldVibration::set_matrix(double beta) {
  energy_.set_step(world_, beta, bases_, box_bases_, point_.positions);
  energy_.start_lagged(point_, still_, point_.positions, beta);
  energy_.hessian(point_, ContactHessian::along_normals, LaggedTerms::Form::derivative, matrix_);
}

/// Times M^-1/2; of vertices that forces do not move, and of the other corners of boxes, zero.
void WorldVibration::scale(VertexArray& values) const {
  for (std::size_t i = 0; i < of_turns_.size(); ++i) {
    const int turn = energy_.boxes()[i].first_vertex + 1;
    values[turn] = Vec3(of_turns_[i] * values[turn]);
  }
  for (int v = 0; v < values.size(); ++v) values[v] *= inverse_root_[at(v)];
}

/// M^-1/2 H M^-1/2 u, of the matrix H that was set.
VectorXd WorldVibration::times_matrix(const VectorXd& u) {
  for (int v = 0; v < values_.size(); ++v) values_[v] = u.segment<3>(3 * v);
  scale(values_);
  matrix_.multiply(values_, product_);
  scale(product_);
  VectorXd result(u.size());
  for (int v = 0; v < product_.size(); ++v) result.segment<3>(3 * v) = product_[v];
  return result;
}

Oscillation WorldVibration::fastest(double weight) {
  const double beta = weight > 0.0 ? 1.0 / weight : longest_step;
  set_matrix(beta);
  const VectorXd u = base::max_eigenvector(
      3 * point_.positions.size(),
      [&](const VectorXd& direction) -> VectorXd { return times_matrix(direction); });
  set_matrix(longest_step);
  const double stiff = u.dot(times_matrix(u));
  set_matrix(damped_step);
  const double both = u.dot(times_matrix(u));
  const double damped = (both - stiff) * damped_step - 1.0 / damped_step;
  return {std::max(0.0, stiff), std::max(0.0, damped)};
}

StabilityLimit stability_limit(WorldVibration& motions, Integrator integrator) {
  return stability_limit(integrator, 1.0, [&](double weight) { return motions.fastest(weight); });
}

}  // namespace pneuma::sim

#include "sim/soft/vibration_mode.h"

#include <algorithm>
#include <cmath>

#include "sim/base/max_eigenvector.h"
#include "sim/soft/bending.h"
#include "sim/soft/damping.h"
#include "sim/soft/incremental_potential.h"
#include "sim/soft/pressure_force.h"

namespace pneuma::sim {

using Eigen::VectorXd;

VibrationMode::VibrationMode(const SoftMesh& mesh, const SoftMaterial& material,
                             const VertexArray& positions)
    : mesh_(mesh),
      stiffness_(material.k / material.vertex_mass),
      dashpot_(dashpot_constant(material) / material.vertex_mass),
      bending_damping_(material.bending_damping),
      drag_(drag_rate(material)),
      pressure_(0.0),
      rank_one_(0.0),
      area_(positions.size()) {
  const auto opposite = opposite_vertices(mesh.topology);
  for (int e = 0; e < mesh.topology.edge_count(); ++e) {
    const auto& [a, b] = mesh.topology.edges()[at(e)];
    const Vec3 edge = positions[b] - positions[a];
    const double length = edge.norm();
    directions_.push_back(length > 0.0 ? Vec3(edge / length) : Vec3(Vec3::Zero()));
    stretch_.push_back(length > 0.0 ? 1.0 - mesh.rest_lengths[at(e)] / length : 0.0);
    across_.push_back(positions[opposite[at(e)][0]] - positions[opposite[at(e)][1]]);
  }
  if (mesh.hinges && material.bending > 0.0) {
    const double rigidity = material.bending / material.vertex_mass;
    for (int e = 0; e < mesh.topology.edge_count(); ++e) {
      hinges_.push_back(hinge_stiffness_root(*mesh.hinges, positions, rigidity, e));
    }
  }
  if (gas_strength(material) == 0.0) return;
  volume_gradient(mesh.topology, positions, area_);
  const double v = volume(positions, area_);
  if (!(v > 0.0)) return;  // the law of gases says nothing then
  const GasLaw gas = gas_law(material);
  pressure_ = gauge_pressure(gas, v) / material.vertex_mass;
  rank_one_ = gas.exponent * (absolute_pressure(gas, v) / material.vertex_mass) / v;
}

/// Springs, and `weight` times the dashpots, which act along them alone.
void VibrationMode::add_springs(const VectorXd& u, double weight, VectorXd& result) const {
  for (int e = 0; e < mesh_.topology.edge_count(); ++e) {
    const auto& [a, b] = mesh_.topology.edges()[at(e)];
    const Vec3 change = u.segment<3>(3 * b) - u.segment<3>(3 * a);
    const double across = stiffness_ * stretch_[at(e)];
    const double along = stiffness_ - across + weight * dashpot_;
    const Vec3& d = directions_[at(e)];
    const Vec3 force = across * change + along * d.dot(change) * d;
    result.segment<3>(3 * b) += force;
    result.segment<3>(3 * a) -= force;
  }
}

/// Hinges, and `weight` times their dashpots.
void VibrationMode::add_hinges(const VectorXd& u, double weight, VectorXd& result) const {
  const double factor = 1.0 + weight * bending_damping_;
  for (std::size_t e = 0; e < hinges_.size(); ++e) {
    const HingeTable::Corners& corners = mesh_.hinges->corners[e];
    double bent = 0.0;
    for (int i = 0; i < 4; ++i) {
      bent += hinges_[e].segment<3>(3 * i).dot(u.segment<3>(3 * corners[at(i)]));
    }
    for (int i = 0; i < 4; ++i) {
      result.segment<3>(3 * corners[at(i)]) += factor * bent * hinges_[e].segment<3>(3 * i);
    }
  }
}

/// -(P - p0) d^2V/dx^2 (incremental_potential.cpp) and g P/V dV/dx dV/dx^T.
void VibrationMode::add_gas(const VectorXd& u, VectorXd& result) const {
  if (rank_one_ == 0.0) return;
  double change = 0.0;
  for (int v = 0; v < area_.size(); ++v) change += area_[v].dot(u.segment<3>(3 * v));
  for (int v = 0; v < area_.size(); ++v) {
    result.segment<3>(3 * v) += rank_one_ * change * area_[v];
  }
  for (int e = 0; e < mesh_.topology.edge_count(); ++e) {
    const auto& [a, b] = mesh_.topology.edges()[at(e)];
    const Vec3 turn = pressure_ / 6.0 * across_[at(e)];
    result.segment<3>(3 * a) += turn.cross(Vec3(u.segment<3>(3 * b)));
    result.segment<3>(3 * b) -= turn.cross(Vec3(u.segment<3>(3 * a)));
  }
}

VectorXd VibrationMode::product(const VectorXd& u, double weight) const {
  VectorXd result = weight * drag_ * u;
  add_springs(u, weight, result);
  add_hinges(u, weight, result);
  add_gas(u, result);
  return result;
}

VectorXd VibrationMode::fastest(double weight) const {
  return base::max_eigenvector(3 * area_.size(),
                               [&](const VectorXd& u) { return product(u, weight); });
}

VectorXd VibrationMode::most_damped(double weight) const {
  return base::max_eigenvector(3 * area_.size(),
                               [&](const VectorXd& u) -> VectorXd { return -product(u, -weight); });
}

VectorXd VibrationMode::faster_than(const VectorXd& u) const {
  constexpr Eigen::Index few = 6;
  return base::max_eigenvector_from(u, few, [&](const VectorXd& v) { return product(v, 0.0); });
}

Oscillation VibrationMode::along(const VectorXd& u) const {
  VectorXd stiff = VectorXd::Zero(u.size()), both = VectorXd::Zero(u.size());
  add_springs(u, 0.0, stiff);
  add_springs(u, 1.0, both);
  double damped = u.dot(both - stiff) + drag_;
  const double of_springs = u.dot(stiff);
  add_hinges(u, 0.0, stiff);
  damped += bending_damping_ * (u.dot(stiff) - of_springs);
  add_gas(u, stiff);
  return {std::max(0.0, u.dot(stiff)), damped};
}

}  // namespace pneuma::sim

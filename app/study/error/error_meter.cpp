#include "app/study/error/error_meter.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "sim/collision/oriented_box.h"
#include "sim/mesh/measure.h"

namespace pneuma::app {
namespace {

using sim::Vec3;

/// 0 where there is neither an error nor anything that it could be compared with.
double relative(double error, double scale) { return error == 0.0 ? 0.0 : std::abs(error / scale); }

sim::OrientedBox oriented(const sim::RigidBox& box) {
  return {box.position, box.orientation.toRotationMatrix(), 0.5 * box.size};
}

StateErrors greater(const StateErrors& a, const StateErrors& b) {
  return {std::max(a.position, b.position), std::max(a.volume, b.volume),
          std::max(a.centre, b.centre),     std::max(a.energy, b.energy),
          std::max(a.momentum, b.momentum), std::max(a.angular_momentum, b.angular_momentum)};
}

double mass(const sim::SoftBody& body) {
  return body.material.vertex_mass * body.mesh->topology.vertex_count();
}

}  // namespace

double rest_radius(const sim::SoftBody& body) { return sim::radius(body.mesh->rest_positions); }

ErrorMeter::ErrorMeter(sim::World world, const Trajectory& reference) : world_(std::move(world)) {
  for (const sim::SoftBody& body : world_.soft) radii_.push_back(rest_radius(body));
  for (const sim::RigidBox& box : world_.rigid) radii_.push_back(0.5 * box.size.norm());
  for (const sim::SoftBody& body : world_.soft) masses_.push_back(mass(body));
  for (const sim::RigidBox& box : world_.rigid) masses_.push_back(box.mass);
  for (const Sample& sample : reference) {
    reference_.push_back(observe(sample));
    energy_scale_ = std::max(energy_scale_, reference_.back().kinetic);
  }
  const double mass = std::accumulate(masses_.begin(), masses_.end(), 0.0);
  momentum_scale_ = std::sqrt(2.0 * mass * energy_scale_);
}

ErrorMeter::Observed ErrorMeter::observe(const Sample& sample) {
  Observed result;
  result.sample = sample;
  for (std::size_t b = 0; b < world_.soft.size(); ++b) {
    sim::SoftBody& body = world_.soft[b];
    body.positions = sample.soft[b].positions;
    body.velocities = sample.soft[b].velocities;
    result.volumes.push_back(sim::volume(body.mesh->topology, body.positions));
    result.centres.push_back(sim::mean(body.positions));
  }
  world_.rigid = sample.rigid;
  for (const sim::RigidBox& box : world_.rigid) result.centres.push_back(box.position);
  const sim::Energy energy = sim::energy(world_);
  result.energy = energy.total();
  result.kinetic = energy.kinetic;
  result.momentum = sim::momentum(world_);
  return result;
}

/// m, of all bodies together.
sim::Vec3 ErrorMeter::centre_of_mass(const Observed& observed) const {
  Vec3 sum = Vec3::Zero();
  double mass = 0.0;
  for (std::size_t b = 0; b < masses_.size(); ++b) {
    sum += masses_[b] * observed.centres[b];
    mass += masses_[b];
  }
  return sum / mass;
}

double ErrorMeter::position_error(const Sample& sample, const Sample& reference) const {
  double squares = 0.0;
  double points = 0.0;
  std::size_t body = 0;
  for (std::size_t b = 0; b < sample.soft.size(); ++b, ++body) {
    const auto& positions = sample.soft[b].positions;
    const double distances = (positions.rows() - reference.soft[b].positions.rows()).squaredNorm();
    squares += distances / (radii_[body] * radii_[body]);
    points += positions.size();
  }
  for (std::size_t b = 0; b < sample.rigid.size(); ++b, ++body) {
    const auto here = oriented(sample.rigid[b]), there = oriented(reference.rigid[b]);
    for (int corner = 0; corner < 8; ++corner) {
      squares += (here.corner(corner) - there.corner(corner)).squaredNorm() /
                 (radii_[body] * radii_[body]);
      points += 1.0;
    }
  }
  return std::sqrt(squares / points);
}

StateErrors ErrorMeter::errors(std::size_t i, const Sample& sample) {
  const Observed& expected = reference_[i];
  const Observed found = observe(sample);
  StateErrors errors;
  errors.position = position_error(sample, expected.sample);
  for (std::size_t b = 0; b < found.volumes.size(); ++b) {
    errors.volume = std::max(errors.volume,
                             relative(found.volumes[b] - expected.volumes[b], expected.volumes[b]));
  }
  for (std::size_t b = 0; b < found.centres.size(); ++b) {
    errors.centre = std::max(errors.centre,
                             relative((found.centres[b] - expected.centres[b]).norm(), radii_[b]));
  }
  errors.energy = relative(found.energy - expected.energy, energy_scale_);
  const Vec3 linear = found.momentum.linear - expected.momentum.linear;
  const Vec3 angular =
      found.momentum.angular - expected.momentum.angular - centre_of_mass(expected).cross(linear);
  errors.momentum = relative(linear.norm(), momentum_scale_);
  errors.angular_momentum =
      relative(angular.norm(), momentum_scale_ * *std::ranges::max_element(radii_));
  return errors;
}

RunErrors ErrorMeter::errors(const Trajectory& trajectory) {
  RunErrors result;
  for (std::size_t i = 0; i < reference_.size(); ++i) {
    result.end = errors(i, trajectory[i]);
    result.greatest = greater(result.greatest, result.end);
  }
  return result;
}

}  // namespace pneuma::app

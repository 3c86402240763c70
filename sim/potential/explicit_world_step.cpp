#include "sim/potential/explicit_world_step.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pneuma::sim {
namespace {

/// Of a pair's distance, or of its reach, that a step leaves at least: the barrier must be met
/// several times before it grows beyond what a step can follow.
constexpr double kept_by_explicit_step = 0.3;
/// Of h^2 K / m: explicit integrators are stable up to some 4.
constexpr double max_contact_stiffness = 1.0;
/// Of the way of a step, that pairs are looked for around vertices.
constexpr double ways_around = 2.0;
/// Of the reach, likewise at least.
constexpr double reaches_around = 0.5;

double max_distance(const VertexArray& one, const VertexArray& other) {
  return std::sqrt((one.rows() - other.rows()).colwise().squaredNorm().maxCoeff());
}

}  // namespace

WorldAcceleration::WorldAcceleration(const World& world, const ContactSurfaces& surfaces)
    : surfaces_(surfaces),
      finder_(surfaces),
      searched_(surfaces.vertex_count()),
      forces_(surfaces.vertex_count()) {
  for (const RigidBox& box : world.rigid) {
    if (box.is_kinematic) continue;
    throw std::invalid_argument(
        box.name + ": explicit integrators step no free boxes where contact is a potential");
  }
  scratch_.reserve(world.soft.size());  // which the equations refer to
  for (int b = 0; b < static_cast<int>(world.soft.size()); ++b) {
    const SoftBody& body = world.soft[at(b)];
    const int count = body.positions.size();
    for (int v = 0; v < count; ++v) {
      const bool is_mobile = surfaces.is_mobile(surfaces[b].first_vertex + v);
      inverse_mass_.push_back(is_mobile ? 1.0 / body.material.vertex_mass : 0.0);
    }
    if (!surfaces[b].is_mobile) continue;
    scratch_.emplace_back(*body.mesh);
    bodies_.push_back(
        {b, surfaces[b].first_vertex, body.material.vertex_mass,
         SoftAcceleration(*body.mesh, body.material, world.settings.gravity, scratch_.back()),
         VertexArray(count), VertexArray(count), VertexArray(count)});
  }
  inverse_mass_.resize(at(surfaces.vertex_count()), 0.0);
}

bool WorldAcceleration::covers(const VertexArray& positions) const {
  return searched_margin_ >= 0.0 && max_distance(positions, searched_) <= searched_margin_;
}

void WorldAcceleration::search(const VertexArray& positions) const {
  searched_.rows() = positions.rows();
  searched_margin_ = margin_;
  finder_.find(positions, positions, margin_, pairs_);
}

double WorldAcceleration::operator()(const VertexArray& positions, const VertexArray& velocities,
                                     VertexArray& acceleration) const {
  acceleration.rows().setZero();
  MinVolume min_volume;
  min_volume.meet(1.0);
  if (!covers(positions)) search(positions);
  find_active(surfaces_, positions, pairs_, active_);
  forces_.rows().setZero();
  add_forces(active_, positions, velocities, surfaces_.regularisation_speed(), forces_);
  for (Body& body : bodies_) {
    const int count = body.positions.size();
    body.positions.rows() = positions.rows().middleCols(body.first_vertex, count);
    body.velocities.rows() = velocities.rows().middleCols(body.first_vertex, count);
    min_volume.meet(body.equation(body.positions, body.velocities, body.acceleration));
    for (int v = 0; v < count; ++v) {
      const int i = body.first_vertex + v;
      if (!surfaces_.is_mobile(i)) continue;
      acceleration[i] = body.acceleration[v] + forces_[i] / body.vertex_mass;
    }
  }
  return min_volume.value();
}

const std::vector<ContactPair>& WorldAcceleration::pairs_between(const VertexArray& from,
                                                                 const VertexArray& to) const {
  if (covers(from) && covers(to)) return pairs_;
  finder_.find(from, to, 0.0, between_);
  return between_;
}

double WorldAcceleration::contact_stiffness(const VertexArray& positions, double step) const {
  if (!covers(positions)) search(positions);
  find_active(surfaces_, positions, pairs_, active_);
  double most = 0.0;
  for (const ActiveContact& contact : active_) {
    double mobility = 0.0;  // 1/kg
    for (int i = 0; i < contact.count; ++i) {
      const double weight = contact.point.weights[at(i)];
      mobility += weight * weight * inverse_mass_[at(contact.vertices[at(i)])];
    }
    most = std::max(most, step * step * contact.barrier.curvature * mobility);
  }
  return most;
}

ExplicitWorldStep::ExplicitWorldStep(const World& world, const ContactSurfaces& surfaces)
    : surfaces_(surfaces),
      acceleration_(world, surfaces),
      scratch_(surfaces.vertex_count()),
      start_{VertexArray(surfaces.vertex_count()), VertexArray(surfaces.vertex_count())} {}

ExplicitWorldReport ExplicitWorldStep::step(const World& world, const WorldState& start,
                                            WorldState& end) {
  const double h = time_step(world.settings);
  double reach = 0.0;
  for (const ContactSurface& surface : surfaces_.all()) reach = std::max(reach, surface.reach);
  const double speed = std::sqrt(start.velocities.rows().colwise().squaredNorm().maxCoeff());
  acceleration_.set_margin(std::max(reaches_around * reach, ways_around * h * speed));
  ExplicitWorldReport report;
  if (acceleration_.contact_stiffness(start.positions, h) > max_contact_stiffness) {
    report.is_too_stiff = true;
    return report;
  }
  start_.positions.rows() = start.positions.rows();
  start_.velocities.rows() = start.velocities.rows();
  report.min_volume = explicit_step(world.settings.integrator, acceleration_, h, start_,
                                    end.positions, end.velocities, scratch_);
  for (int v = 0; v < end.positions.size(); ++v) {
    if (surfaces_.is_mobile(v)) continue;
    end.positions[v] = start.positions[v] + h * start.velocities[v];
    end.velocities[v] = start.velocities[v];
  }
  if (!std::isfinite(end.positions.rows().sum())) return report;
  const std::vector<ContactPair>& pairs =
      acceleration_.pairs_between(start.positions, end.positions);
  report.limit =
      limit_ways(surfaces_, pairs, start.positions, end.positions, kept_by_explicit_step);
  if (report.limit.pair >= 0) report.limiting_pair = pairs[at(report.limit.pair)];
  return report;
}

}  // namespace pneuma::sim

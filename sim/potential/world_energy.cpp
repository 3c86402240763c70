#include "sim/potential/world_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/soft/bending.h"

namespace pneuma::sim {

WorldEnergy::WorldEnergy(const World& world, const ContactSurfaces& surfaces)
    : surfaces_(surfaces), targets_(surfaces.vertex_count()) {
  for (int b = 0; b < static_cast<int>(world.soft.size()); ++b) {
    const SoftBody& body = world.soft[at(b)];
    if (!surfaces[b].is_mobile) continue;
    bodies_.push_back({b, surfaces[b].first_vertex, body.mesh.get(),
                       opposite_vertices(body.mesh->topology), IncrementalPotential(*body.mesh)});
    scratch_.emplace_back(body.positions.size());
    if (body.pins) bodies_.back().energy.is_pinned = body.pins->is_pinned.data();
  }
}

WorldPoint WorldEnergy::make_point() const {
  WorldPoint point;
  point.positions = VertexArray(surfaces_.vertex_count());
  for (const Body& body : bodies_) point.bodies.emplace_back(*body.mesh);
  return point;
}

void WorldEnergy::set_step(const World& world, double beta, const std::vector<EulerBase>& bases,
                           const VertexArray& targets) {
  targets_.rows() = targets.rows();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    const SoftMaterial& material = world.soft[at(body.soft)].material;
    set_step_energy(*body.mesh, material, world.settings.gravity, beta, bases[i], body.energy);
    for (int v = 0; v < body.energy.target.size(); ++v) {
      if (!surfaces_.is_mobile(body.first_vertex + v)) {
        body.energy.target[v] = targets[body.first_vertex + v];
      }
    }
  }
  lagged_.start({}, targets, targets, beta, surfaces_.regularisation_speed());
}

void WorldEnergy::start_lagged(const std::vector<ActiveContact>& active,
                               const VertexArray& velocities, const VertexArray& base,
                               double beta) {
  lagged_.start(active, velocities, base, beta, surfaces_.regularisation_speed());
}

bool WorldEnergy::evaluate(const std::vector<ContactPair>& pairs, WorldPoint& point) const {
  point.energy = point.magnitude = 0.0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    EnergyPoint& own = point.bodies[i];
    own.positions.rows() =
        point.positions.rows().middleCols(body.first_vertex, own.positions.size());
    if (!sim::evaluate(*body.mesh, body.energy, own)) return false;
    point.energy += own.energy;
    point.magnitude += own.magnitude;
  }
  const double contact = find_active(surfaces_, point.positions, pairs, point.active);
  const double lagged = lagged_.energy(point.positions);
  point.energy += contact + lagged;
  point.magnitude += contact + lagged;
  return std::isfinite(point.energy);
}

void WorldEnergy::gradient(const WorldPoint& point, VertexArray& gradient) const {
  gradient.rows().setZero();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    const EnergyPoint& own = point.bodies[i];
    VertexArray& part = scratch_[i];
    gradient_without_gas(*body.mesh, body.energy, own, part);
    if (body.energy.gas.strength > 0.0) {
      part.rows() -= pressure(body.energy, own) * own.volume_gradient.rows();
    }
    gradient.rows().middleCols(body.first_vertex, part.size()) = part.rows();
  }
  add_gradient(point.active, point.positions, gradient);
  lagged_.add_gradient(point.positions, gradient);
  for (int v = 0; v < gradient.size(); ++v) {
    if (!surfaces_.is_mobile(v)) gradient[v].setZero();
  }
}

void WorldEnergy::add_hinges(const Body& body, const EnergyPoint& own, ContactHessian form,
                             WorldMatrix& matrix) {
  if (!body.mesh->hinges || body.energy.bending == 0.0) return;
  const auto& all = body.mesh->hinges->corners;
  for (std::size_t e = 0; e < all.size(); ++e) {
    const HingeHessian block =
        hinge_hessian(*body.mesh, own.positions, body.energy.bending, static_cast<int>(e));
    HingeTable::Corners corners = all[e];
    for (int& v : corners) v += body.first_vertex;
    matrix.add_whole(corners, form == ContactHessian::positive ? positive_part(block) : block);
  }
}

void WorldEnergy::hessian(const WorldPoint& point, ContactHessian form, WorldMatrix& matrix) const {
  matrix.clear();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    const EnergyPoint& own = point.bodies[i];
    const int first = body.first_vertex;
    for (int v = 0; v < own.positions.size(); ++v) {
      matrix.add_diagonal(first + v, body.energy.inertia);
    }
    const auto& edges = body.mesh->topology.edges();
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const EdgeHessian of_edge = edge_hessian(*body.mesh, body.energy, own, body.opposite, e);
      matrix.add(first + edges[e][0], of_edge.own);
      matrix.add(first + edges[e][1], of_edge.own);
      matrix.add_between(first + edges[e][0], first + edges[e][1], of_edge.between);
    }
    add_hinges(body, own, form, matrix);
    if (body.energy.gas.strength > 0.0) {
      scratch_[i].rows() =
          std::sqrt(pressure_slope(body.energy.gas, own.volume)) * own.volume_gradient.rows();
      matrix.add_rank_one(first, scratch_[i]);
    }
  }
  for (const ActiveContact& contact : point.active) {
    const bool is_whole =
        contact.count == 4 && (form == ContactHessian::positive || contact.is_mollified());
    if (is_whole) {
      matrix.add_whole(contact.vertices, positive_part(contact_hessian(contact, point.positions)));
      continue;
    }
    const Vec3 normal = contact.point.normal();
    matrix.blocks().push_back({contact.vertices, contact.count, contact.point.weights,
                               contact.barrier.curvature * normal * normal.transpose()});
  }
  lagged_.append_hessian(point.positions, matrix.blocks());
}

double WorldEnergy::inertia() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Body& body : bodies_) least = std::min(least, body.energy.inertia);
  return least;
}

double WorldEnergy::gas_scale() const {
  double most = 0.0;
  for (const Body& body : bodies_) most = std::max(most, body.energy.gas.strength);
  return most > 0.0 ? most : std::numeric_limits<double>::infinity();
}

}  // namespace pneuma::sim

#include "sim/potential/world_energy.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/soft/bending.h"

namespace pneuma::sim {
namespace {

/// Of a box's inertia, what is left of its second derivative by turning at least.
constexpr double min_turning_fraction = 0.1;

}  // namespace

WorldEnergy::WorldEnergy(const World& world, const ContactSurfaces& surfaces)
    : surfaces_(surfaces), targets_(surfaces.vertex_count()), slopes_(surfaces.vertex_count()) {
  for (int b = 0; b < static_cast<int>(world.soft.size()); ++b) {
    const SoftBody& body = world.soft[at(b)];
    if (!surfaces[b].is_mobile) continue;
    bodies_.push_back({b, surfaces[b].first_vertex, body.mesh.get(),
                       opposite_vertices(body.mesh->topology), IncrementalPotential(*body.mesh)});
    scratch_.emplace_back(body.positions.size());
    if (body.pins) bodies_.back().energy.is_pinned = body.pins->is_pinned.data();
  }
  for (int i = 0; i < static_cast<int>(world.rigid.size()); ++i) {
    const RigidBox& box = world.rigid[at(i)];
    if (!box.is_kinematic) {
      boxes_.push_back({i, surfaces.of_box(i).first_vertex, BoxInertia(box)});
    }
  }
}

WorldPoint WorldEnergy::make_point() const {
  WorldPoint point;
  point.positions = VertexArray(surfaces_.vertex_count());
  for (const Body& body : bodies_) point.bodies.emplace_back(*body.mesh);
  point.boxes.resize(boxes_.size());
  return point;
}

void WorldEnergy::set_step(const World& world, double beta, const std::vector<EulerBase>& bases,
                           const std::vector<RigidState>& box_bases, const VertexArray& targets) {
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
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    boxes_[i].energy.set_step(box_bases[i], world.settings.gravity, beta);
  }
  lagged_.start({}, targets, targets, targets, beta, surfaces_.regularisation_speed());
}

void WorldEnergy::start_lagged(const WorldPoint& point, const VertexArray& velocities,
                               const VertexArray& base, double beta) {
  lagged_.start(point.active, point.positions, velocities, base, beta,
                surfaces_.regularisation_speed());
}

void WorldEnergy::place_boxes(WorldPoint& point) const {
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    surfaces_.place_box(point.boxes[i], boxes_[i].index, point.positions);
  }
}

BoxFrame WorldEnergy::frame_of(const WorldPoint& point, std::size_t box) const {
  BoxFrame frame{boxes_[box].first_vertex, {}};
  for (int i = 0; i < box_corners; ++i) {
    frame.arms[at(i)] = point.positions[frame.first_vertex + i] - point.boxes[box].position;
  }
  return frame;
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
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const double own = boxes_[i].energy.energy(point.boxes[i]);
    point.energy += own;
    point.magnitude += own;
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
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const BoxFrame frame = frame_of(point, i);
    contract(frame, gradient);
    set_six(frame, six_of(frame, gradient) + boxes_[i].energy.gradient(point.boxes[i]), gradient);
  }
}

void WorldEnergy::add_hinges(const Body& body, const EnergyPoint& own, WorldMatrix& matrix) {
  if (body.energy.bending == 0.0) return;
  const auto& all = body.energy.hinges.corners;
  for (std::size_t e = 0; e < all.size(); ++e) {
    const HingeHessian block =
        hinge_hessian(body.energy.hinges, own.positions, body.energy.bending, static_cast<int>(e));
    HingeTable::Corners corners = all[e];
    for (int& v : corners) v += body.first_vertex;
    matrix.add(corners, block);
  }
}

void WorldEnergy::hessian(const WorldPoint& point, ContactHessian form, LaggedTerms::Form lagged,
                          WorldMatrix& matrix) const {
  matrix.clear();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    const EnergyPoint& own = point.bodies[i];
    const int first = body.first_vertex;
    for (int v = 0; v < own.positions.size(); ++v) {
      matrix.add_diagonal(first + v, body.energy.inertia);
    }
    const double gauge = pressure(body.energy, own);
    const auto& edges = body.mesh->topology.edges();
    for (std::size_t e = 0; e < edges.size(); ++e) {
      EdgeHessian of_edge;
      find_edge_hessian(*body.mesh, body.energy, own, gauge, body.opposite, e, of_edge);
      const Mat3 own_block = to_mat3(of_edge.own);
      matrix.add(first + edges[e][0], own_block);
      matrix.add(first + edges[e][1], own_block);
      matrix.add_between(first + edges[e][0], first + edges[e][1], of_edge.between);
    }
    add_hinges(body, own, matrix);
    if (body.energy.gas.strength > 0.0) {
      scratch_[i].rows() =
          std::sqrt(pressure_slope(body.energy.gas, own.volume)) * own.volume_gradient.rows();
      matrix.add_rank_one(first, scratch_[i]);
    }
  }
  add_boxes(point, matrix);
  for (const ActiveContact& contact : point.active) {
    if (contact.count == 4 && (form == ContactHessian::whole || contact.is_mollified())) {
      const Mat12 block = contact_hessian(contact, point.positions);
      matrix.add(contact.vertices, form == ContactHessian::whole ? block : positive_part(block));
      continue;
    }
    const Vec3 normal = contact.point.normal();
    matrix.blocks().push_back({contact.vertices, contact.count, contact.point.weights,
                               contact.barrier.curvature * normal * normal.transpose()});
  }
  lagged_.append_hessian(point.positions, lagged, matrix.blocks());
}

/// The turning of corners that are pushed is part of a box's own block, which is kept positive.
void WorldEnergy::add_boxes(const WorldPoint& point, WorldMatrix& matrix) const {
  if (boxes_.empty()) return;
  slopes_.rows().setZero();
  add_gradient(point.active, point.positions, slopes_);
  lagged_.add_gradient(point.positions, slopes_);
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const BoxInertia& inertia = boxes_[i].energy;
    const BoxFrame frame = frame_of(point, i);
    Mat6 own = inertia.hessian(point.boxes[i]);
    // Measured by the roots of the moments of inertia, so that no axis is as stiff as a longer one.
    const Mat3 roots = inertia.turning_inertia().cwiseSqrt().asDiagonal();
    const Mat3 axes = point.boxes[i].orientation * roots;
    const Mat3 measures = point.boxes[i].orientation * Mat3(roots.inverse());
    const Mat3 turning = own.bottomRightCorner<3, 3>() + turning_hessian(frame, slopes_);
    const Eigen::SelfAdjointEigenSolver<Mat3> parts(measures.transpose() * turning * measures);
    const Mat3 directions = axes * parts.eigenvectors();
    own.bottomRightCorner<3, 3>() =
        directions * parts.eigenvalues().cwiseMax(min_turning_fraction).asDiagonal() *
        directions.transpose();
    matrix.add_box(frame, own, inertia.squared_radius());
  }
}

double WorldEnergy::inertia() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Body& body : bodies_) least = std::min(least, body.energy.inertia);
  for (const Box& box : boxes_) least = std::min(least, box.energy.per_length());
  return least;
}

double WorldEnergy::gas_scale() const {
  double most = 0.0;
  for (const Body& body : bodies_) most = std::max(most, body.energy.gas.strength);
  return most > 0.0 ? most : std::numeric_limits<double>::infinity();
}

}  // namespace pneuma::sim

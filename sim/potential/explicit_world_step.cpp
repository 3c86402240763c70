#include "sim/potential/explicit_world_step.h"

#include <algorithm>
#include <cmath>

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
/// rad, by which a box turns at most in a step: integrators follow it, and it is nowhere turned
/// inside out on the straight ways of its corners.
constexpr double max_turn_per_step = 1.0;

/// -1: none.
int find_fast_box(const std::vector<RigidState>& start, const std::vector<RigidState>& end,
                  double step) {
  for (std::size_t i = 0; i < end.size(); ++i) {
    const double rate = std::max(start[i].angular_velocity.norm(), end[i].angular_velocity.norm());
    if (rate * step > max_turn_per_step) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace

BoxCoordinates::Form box_form_for(Integrator integrator) {
  const bool by_runge_kutta = integrator == Integrator::rk4 || integrator == Integrator::rk8;
  return by_runge_kutta ? BoxCoordinates::Form::quaternion : BoxCoordinates::Form::momentum;
}

WorldAcceleration::WorldAcceleration(const World& world, const ContactSurfaces& surfaces,
                                     BoxCoordinates::Form form)
    : surfaces_(surfaces),
      gravity_(world.settings.gravity),
      kept_(surfaces),
      between_(surfaces),
      forces_(surfaces.vertex_count()) {
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
  for (int i = 0; i < static_cast<int>(world.rigid.size()); ++i) {
    const RigidBox& box = world.rigid[at(i)];
    if (box.is_kinematic) continue;
    const int first = surfaces.of_box(i).first_vertex;
    boxes_.push_back({i, static_cast<int>(world.soft.size()) + i, BoxCoordinates(box, first, form),
                      state_of(box), BoxFrame{first, {}}});
  }
  if (boxes_.empty()) return;
  corners_ = VertexArray(surfaces.vertex_count());
  corner_velocities_ = VertexArray(surfaces.vertex_count());
}

void WorldAcceleration::start_boxes(const std::vector<RigidState>& boxes, VertexArray& positions,
                                    VertexArray& velocities) {
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    boxes_[i].coordinates.start(boxes[i], positions, velocities);
  }
}

void WorldAcceleration::end_boxes(VertexArray& positions, VertexArray& velocities,
                                  std::vector<RigidState>& boxes) const {
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    boxes[i] = boxes_[i].coordinates.state(positions, velocities);
    surfaces_.place_box({boxes[i].position, boxes[i].orientation}, boxes_[i].index, positions);
    move_corners(boxes[i], boxes_[i].frame.first_vertex, positions, velocities);
  }
}

/// Into corners_ and corner_velocities_.
void WorldAcceleration::place_boxes(const VertexArray& positions,
                                    const VertexArray& velocities) const {
  corners_.rows() = positions.rows();
  corner_velocities_.rows() = velocities.rows();
  for (Box& box : boxes_) {
    box.state = box.coordinates.state(positions, velocities);
    surfaces_.place_box({box.state.position, box.state.orientation}, box.index, corners_);
    move_corners(box.state, box.frame.first_vertex, corners_, corner_velocities_);
    for (int i = 0; i < box_corners; ++i) {
      box.frame.arms[at(i)] = corners_[box.frame.first_vertex + i] - box.state.position;
    }
  }
}

double WorldAcceleration::operator()(const VertexArray& positions, const VertexArray& velocities,
                                     VertexArray& acceleration) const {
  acceleration.rows().setZero();
  MinVolume min_volume;
  min_volume.meet(1.0);
  if (!boxes_.empty()) place_boxes(positions, velocities);
  const VertexArray& x = vertices(positions);
  const VertexArray& v = boxes_.empty() ? velocities : corner_velocities_;
  if (!kept_.cover(x)) kept_.find(x, x, margin_);
  find_active(surfaces_, x, kept_.pairs(), active_);
  forces_.rows().setZero();
  add_forces(active_, x, v, surfaces_.regularisation_speed(), forces_);
  for (Body& body : bodies_) {
    const int count = body.positions.size();
    body.positions.rows() = positions.rows().middleCols(body.first_vertex, count);
    body.velocities.rows() = velocities.rows().middleCols(body.first_vertex, count);
    min_volume.meet(body.equation(body.positions, body.velocities, body.acceleration));
    for (int i = 0; i < count; ++i) {
      const int vertex = body.first_vertex + i;
      if (!surfaces_.is_mobile(vertex)) continue;
      acceleration[vertex] = body.acceleration[i] + forces_[vertex] / body.vertex_mass;
    }
  }
  for (const Box& box : boxes_) {
    contract(box.frame, forces_);
    box.coordinates.accelerate(box.state, six_of(box.frame, forces_), gravity_, acceleration);
  }
  return min_volume.value();
}

const std::vector<ContactPair>& WorldAcceleration::pairs_between(const VertexArray& from,
                                                                 const VertexArray& to) const {
  if (kept_.cover(from) && kept_.cover(to)) return kept_.pairs();
  between_.find(from, to, 0.0);
  return between_.pairs();
}

/// 1/kg, of a force between the sides of a contact along its normal.
double WorldAcceleration::mobility_of_boxes(const ActiveContact& contact) const {
  double mobility = 0.0;
  for (const Box& box : boxes_) {
    if (box.surface != contact.first && box.surface != contact.second) continue;
    Vec6 force = Vec6::Zero();
    for (int i = 0; i < contact.count; ++i) {
      const int vertex = contact.vertices[at(i)];
      if (!box.frame.has(vertex)) continue;
      const Vec3 arm = corners_[vertex] - box.state.position;
      const Vec3 part = contact.point.weights[at(i)] * contact.point.normal();
      force.head<3>() += part;
      force.tail<3>() += arm.cross(part);
    }
    mobility += box.coordinates.mobility(box.state, force);
  }
  return mobility;
}

double WorldAcceleration::contact_stiffness(double step) const {
  double most = 0.0;
  for (const ActiveContact& contact : active_) {
    double mobility = boxes_.empty() ? 0.0 : mobility_of_boxes(contact);  // 1/kg
    for (int i = 0; i < contact.count; ++i) {
      const double weight = contact.point.weights[at(i)];
      mobility += weight * weight * inverse_mass_[at(contact.vertices[at(i)])];
    }
    most = std::max(most, step * step * contact.barrier.curvature * mobility);
  }
  return most;
}

namespace {

/// The equation as the stages of a step evaluate it, and what they meet: a stage that lies beyond a
/// crossing, or so deep in a barrier that the step cannot follow it, makes the whole step worthless
/// even if it ends well.
class WatchedStages {
 public:
  WatchedStages(const ContactSurfaces& surfaces, const WorldAcceleration& acceleration,
                const VertexArray& start, double step, ExplicitWorldReport& report)
      : surfaces_(surfaces),
        acceleration_(acceleration),
        start_(start),
        step_(step),
        report_(report) {}

  double operator()(const VertexArray& positions, const VertexArray& velocities,
                    VertexArray& result) const {
    const double volume = acceleration_(positions, velocities, result);
    report_.is_too_stiff |= acceleration_.contact_stiffness(step_) > max_contact_stiffness;
    const VertexArray& reached = acceleration_.vertices(positions);
    const bool is_start = reached.rows() == start_.rows();
    if (!is_start && std::isfinite(reached.rows().sum())) limit_way(reached, 0.0);
    return volume;
  }

  /// Of the straight ways from the start of the step.
  void limit_way(const VertexArray& reached, double kept) const {
    if (report_.limit.is_limited) return;
    const std::vector<ContactPair>& pairs = acceleration_.pairs_between(start_, reached);
    report_.limit = limit_ways(surfaces_, pairs, start_, reached, kept);
    if (report_.limit.pair >= 0) report_.limiting_pair = pairs[at(report_.limit.pair)];
  }

 private:
  const ContactSurfaces& surfaces_;
  const WorldAcceleration& acceleration_;
  const VertexArray& start_;
  double step_;
  ExplicitWorldReport& report_;
};

}  // namespace

ExplicitWorldStep::ExplicitWorldStep(const World& world, const ContactSurfaces& surfaces)
    : surfaces_(surfaces),
      acceleration_(world, surfaces, box_form_for(world.settings.integrator)),
      scratch_(surfaces.vertex_count(), world.settings.integrator),
      start_{VertexArray(surfaces.vertex_count()), VertexArray(surfaces.vertex_count())} {}

ExplicitWorldReport ExplicitWorldStep::step(const World& world, const WorldState& start,
                                            WorldState& end) {
  const double h = time_step(world.settings);
  double reach = 0.0;
  for (const ContactSurface& surface : surfaces_.all()) reach = std::max(reach, surface.reach);
  const double speed = std::sqrt(start.velocities.rows().colwise().squaredNorm().maxCoeff());
  acceleration_.set_margin(std::max(reaches_around * reach, ways_around * h * speed));
  acceleration_.take_gas(world);
  ExplicitWorldReport report;
  start_.positions.rows() = start.positions.rows();
  start_.velocities.rows() = start.velocities.rows();
  acceleration_.start_boxes(start.boxes, start_.positions, start_.velocities);
  const WatchedStages stages(surfaces_, acceleration_, start.positions, h, report);
  report.min_volume = explicit_step(world.settings.integrator, stages, h, start_, end.positions,
                                    end.velocities, scratch_);
  acceleration_.end_boxes(end.positions, end.velocities, end.boxes);
  for (int v = 0; v < end.positions.size(); ++v) {
    if (surfaces_.is_mobile(v)) continue;
    end.positions[v] = start.positions[v] + h * start.velocities[v];
    end.velocities[v] = start.velocities[v];
  }
  if (!std::isfinite(end.positions.rows().sum())) return report;
  report.fast_box = find_fast_box(start.boxes, end.boxes, h);
  if (report.fast_box >= 0) return report;
  stages.limit_way(end.positions, kept_by_explicit_step);
  return report;
}

}  // namespace pneuma::sim

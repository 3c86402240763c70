#include "sim/potential/implicit_world_step.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/mesh/measure.h"
#include "sim/soft/bending.h"
#include "sim/soft/spring_force.h"

namespace pneuma::sim {
namespace {

/// Of the least mean edge: how far from the minimum a vertex may end.
constexpr double world_tolerance_fraction = 1e-8;
constexpr double world_rounding = 1e-13;

WorldState make_state(int vertex_count, std::size_t boxes) {
  return {VertexArray(vertex_count), VertexArray(vertex_count), std::vector<RigidState>(boxes)};
}

/// sdirk2's, as in sim/soft/implicit_step.cpp.
constexpr double sdirk_part = 1.0 - 0.5 * std::numbers::sqrt2;
constexpr double sdirk_extrapolation = 1.0 + std::numbers::sqrt2;

}  // namespace

ImplicitWorldStep::ImplicitWorldStep(const World& world, const ContactSurfaces& surfaces)
    : surfaces_(surfaces),
      energy_(world, surfaces),
      minimiser_(surfaces, energy_),
      extrapolated_(make_state(surfaces.vertex_count(), energy_.boxes().size())),
      middle_(extrapolated_),
      targets_(surfaces.vertex_count()) {
  double least_edge = std::numeric_limits<double>::infinity();
  for (const WorldEnergy::Body& body : energy_.bodies()) {
    bases_.emplace_back(*body.mesh);
    start_deformations_.emplace_back(*body.mesh);
    own_.emplace_back(body.mesh->topology.vertex_count());
    least_edge = std::min(least_edge, surfaces[body.soft].tree->mean_edge());
  }
  for (const WorldEnergy::Box& box : energy_.boxes()) {
    least_edge = std::min(least_edge, surfaces.of_box(box.index).tree->mean_edge());
  }
  tolerance_ = world_tolerance_fraction * least_edge;
}

/// Of one body, until the next call for it.
const VertexArray& ImplicitWorldStep::own_part(const VertexArray& all, std::size_t i) {
  own_[i].rows() = all.rows().middleCols(energy_.bodies()[i].first_vertex, own_[i].size());
  return own_[i];
}

ImplicitWorldReport ImplicitWorldStep::step(const World& world, const WorldState& start,
                                            WorldState& end) {
  report_ = {};
  const double h = time_step(world.settings);
  extrapolated_.positions.rows() = start.positions.rows() + h * start.velocities.rows();
  minimiser_.find_pairs(start.positions, extrapolated_.positions);
  does_work_ = false;
  for (int v = 0; v < start.velocities.size(); ++v) {
    does_work_ |= !surfaces_.is_mobile(v) && !Vec3(start.velocities[v]).isZero(0.0);
  }
  for (std::size_t i = 0; i < bases_.size(); ++i) {
    const WorldEnergy::Body& body = energy_.bodies()[i];
    measure(*body.mesh, world.soft[at(body.soft)].material, own_part(start.positions, i),
            start_deformations_[i]);
  }
  const double speed_energy = kinetic(world, start);
  start_energy_ = potential(world, start) + speed_energy;
  report_.is_valid = std::isfinite(start_energy_);
  if (!report_.is_valid) return report_;
  start_energy_ += world_rounding * (magnitude_ + speed_energy);
  const bool by_sdirk = world.settings.integrator == Integrator::sdirk2;
  report_.by_euler = by_sdirk && !sdirk2(world, h, start, end);
  if (!by_sdirk || report_.by_euler) implicit_euler(world, h, start, end);
  if (!report_.arrived || !report_.is_valid) return report_;
  keep_given(start, h, end);
  if (!does_work_) {
    const double left = std::max(0.0, start_energy_ - potential(world, end));
    report_.excess = std::max(0.0, kinetic(world, end) - left);
  }
  return report_;
}

bool ImplicitWorldStep::implicit_euler(const World& world, double step, const WorldState& start,
                                       WorldState& end) {
  for (std::size_t i = 0; i < bases_.size(); ++i) bases_[i].deformation = start_deformations_[i];
  if (!minimise(world, step, start, start, start, step)) return false;
  end.positions.rows() = minimiser_.point().positions.rows();
  end.velocities.rows() = (end.positions.rows() - start.positions.rows()) / step;
  finish(end);
  return true;
}

/// Boxes where the minimiser has ended, with their velocities.
void ImplicitWorldStep::finish(WorldState& end) const {
  for (std::size_t i = 0; i < end.boxes.size(); ++i) {
    end.boxes[i] = energy_.boxes()[i].energy.state_at(minimiser_.point().boxes[i]);
  }
  move_corners(end);
}

/// False when the step must be left to implicit_euler.
bool ImplicitWorldStep::sdirk2(const World& world, double step, const WorldState& start,
                               WorldState& end) {
  const double part = sdirk_part * step;
  for (std::size_t i = 0; i < bases_.size(); ++i) bases_[i].deformation = start_deformations_[i];
  if (!minimise(world, part, start, start, start, part)) return false;
  middle_.positions.rows() = minimiser_.point().positions.rows();
  middle_.velocities.rows() = (middle_.positions.rows() - start.positions.rows()) / part;
  finish(middle_);

  const auto change = middle_.positions.rows() - start.positions.rows();
  extrapolated_.positions.rows() = start.positions.rows() + sdirk_extrapolation * change;
  extrapolated_.velocities.rows() =
      start.velocities.rows() + sdirk_extrapolation * (change / part - start.velocities.rows());
  extrapolate_boxes();
  for (std::size_t i = 0; i < bases_.size(); ++i) {
    const WorldEnergy::Body& body = energy_.bodies()[i];
    measure(*body.mesh, world.soft[at(body.soft)].material, own_part(middle_.positions, i),
            bases_[i].deformation);
    extrapolate(start_deformations_[i], sdirk_extrapolation, bases_[i].deformation);
  }
  if (!minimise(world, part, extrapolated_, middle_, middle_, step - part)) return false;
  end.positions.rows() = minimiser_.point().positions.rows();
  end.velocities.rows() = (end.positions.rows() - extrapolated_.positions.rows()) / part;
  finish(end);
  return does_work_ || potential(world, end) <= start_energy_;
}

void ImplicitWorldStep::extrapolate_boxes() {
  for (std::size_t i = 0; i < middle_.boxes.size(); ++i) {
    const WorldEnergy::Box& box = energy_.boxes()[i];
    RigidState& to = extrapolated_.boxes[i];
    to = box.energy.extrapolate(middle_.boxes[i], sdirk_extrapolation);
    surfaces_.place_box({to.position, to.orientation}, box.index, extrapolated_.positions);
  }
}

/// Of a step of `beta` from `base`, starting at `guess`, with friction and restitution as of `lag`.
/// `way`: s, in which what keys move goes on from the guess.
bool ImplicitWorldStep::minimise(const World& world, double beta, const WorldState& base,
                                 const WorldState& lag, const WorldState& guess, double way) {
  targets_.rows() = guess.positions.rows() + way * lag.velocities.rows();
  for (std::size_t i = 0; i < bases_.size(); ++i) {
    const WorldEnergy::Body& body = energy_.bodies()[i];
    const int count = bases_[i].state.positions.size();
    bases_[i].state.positions.rows() = base.positions.rows().middleCols(body.first_vertex, count);
    bases_[i].state.velocities.rows() = base.velocities.rows().middleCols(body.first_vertex, count);
  }
  energy_.set_step(world, beta, bases_, base.boxes, targets_);
  WorldPoint& point = minimiser_.point();
  point.positions.rows() = guess.positions.rows();
  for (std::size_t i = 0; i < point.boxes.size(); ++i) {
    point.boxes[i] = {guess.boxes[i].position, guess.boxes[i].orientation};
  }
  if (!minimiser_.begin()) {
    report_.is_valid = false;
    return false;
  }
  energy_.start_lagged(point, lag.velocities, base.positions, beta);
  if (!minimiser_.begin()) {
    report_.is_valid = false;
    return false;
  }
  const double rounding = 4e-15 * guess.positions.rows().cwiseAbs().maxCoeff();
  const WorldMinimiserReport done = minimiser_.minimise(std::max(tolerance_, rounding));
  report_.iterations += done.iterations;
  report_.gradient_iterations = minimiser_.gradient_iterations();
  report_.converged &= done.converged;
  report_.arrived = done.arrived;
  if (!done.arrived) {
    report_.blocked = done.blocked;
    report_.blocked_pair = done.blocked_pair;
  }
  return done.arrived;
}

/// The velocities of free boxes' corners.
void ImplicitWorldStep::move_corners(WorldState& state) const {
  for (std::size_t i = 0; i < state.boxes.size(); ++i) {
    sim::move_corners(state.boxes[i], energy_.boxes()[i].first_vertex, state.positions,
                      state.velocities);
  }
}

/// What forces do not move keeps its velocity.
void ImplicitWorldStep::keep_given(const WorldState& start, double step, WorldState& end) const {
  for (int v = 0; v < end.positions.size(); ++v) {
    if (surfaces_.is_mobile(v)) continue;
    end.velocities[v] = start.velocities[v];
    end.positions[v] = start.positions[v] + step * start.velocities[v];
  }
}

double ImplicitWorldStep::kinetic(const World& world, const WorldState& state) const {
  double sum = 0.0;
  for (const WorldEnergy::Body& body : energy_.bodies()) {
    const int count = body.mesh->topology.vertex_count();
    sum += 0.5 * world.soft[at(body.soft)].material.vertex_mass *
           state.velocities.rows().middleCols(body.first_vertex, count).squaredNorm();
  }
  return sum + kinetic_of_boxes(world, state);
}

double ImplicitWorldStep::kinetic_of_boxes(const World& world, const WorldState& state) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < state.boxes.size(); ++i) {
    sum += kinetic_energy(world.rigid[at(energy_.boxes()[i].index)], state.boxes[i]);
  }
  return sum;
}

/// Of springs, hinges, gas, gravity and contacts. Adds the sizes of the terms up in magnitude_.
double ImplicitWorldStep::potential(const World& world, const WorldState& state) {
  const VertexArray& positions = state.positions;
  double sum = 0.0;
  magnitude_ = 0.0;
  for (std::size_t i = 0; i < bases_.size(); ++i) {
    const WorldEnergy::Body& body = energy_.bodies()[i];
    const SoftMaterial& material = world.soft[at(body.soft)].material;
    const VertexArray& own = own_part(positions, i);
    const double springs = spring_energy(*body.mesh, own, material.k) +
                           bending_energy(*body.mesh, own, material.bending);
    const GasLaw law = gas_law(material);
    const double enclosed = volume(body.mesh->topology, own);
    if (law.strength > 0.0 && !(enclosed > 0.0)) return std::numeric_limits<double>::infinity();
    const double gravity =
        -material.vertex_mass * own.size() * world.settings.gravity.dot(mean(own));
    sum += springs + gas_energy(law, enclosed) + gravity;
    magnitude_ += springs + gas_energy_size(law, enclosed) + std::abs(gravity);
  }
  for (std::size_t i = 0; i < state.boxes.size(); ++i) {
    const double mass = world.rigid[at(energy_.boxes()[i].index)].mass;
    const double gravity = -mass * world.settings.gravity.dot(state.boxes[i].position);
    sum += gravity;
    magnitude_ += std::abs(gravity);
  }
  const double contacts = contact_energy(surfaces_, positions, minimiser_.pairs_at(positions));
  magnitude_ += contacts;
  return sum + contacts;
}

}  // namespace pneuma::sim

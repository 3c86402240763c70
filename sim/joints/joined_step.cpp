#include "sim/joints/joined_step.h"

#include <algorithm>
#include <utility>

#include "sim/joints/body_springs.h"
#include "sim/soft/pins.h"

namespace pneuma::sim {

JoinedStep::JoinedStep(const World& world, std::vector<int> bodies) : bodies_(std::move(bodies)) {
  std::vector<std::size_t> piece_of(world.soft.size());
  int count = 0;
  for (const int i : bodies_) {
    const SoftBody& body = world.soft[at(i)];
    piece_of[at(i)] = pieces_.size();
    Piece& piece = pieces_.emplace_back();
    piece.first = count;
    piece.is_obstacle = is_kinematic(body);
    const int vertices = body.positions.size();
    piece.state = {VertexArray(vertices), VertexArray(vertices)};
    piece.accelerations = VertexArray(vertices);
    count += vertices;
  }
  for (std::size_t i = 0; i < world.springs.size(); ++i) {
    const BodySpring& spring = world.springs[i];
    if (std::ranges::find(bodies_, spring.first.body) == bodies_.end()) continue;
    springs_.push_back({i, piece_of[at(spring.first.body)], piece_of[at(spring.second.body)]});
  }
  min_volumes_.resize(pieces_.size());
  start_ = end_ = {VertexArray(count), VertexArray(count)};
  changes_ = predicted_ = VertexArray(count);
  if (!is_implicit(world.settings.integrator)) {
    all_ = std::make_unique<ExplicitScratch>(count, world.settings.integrator);
  }
}

void JoinedStep::gather(std::span<const SoftState> start) {
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const SoftState& own = start[at(bodies_[i])];
    const auto first = pieces_[i].first, count = own.positions.size();
    start_.positions.rows().middleCols(first, count) = own.positions.rows();
    start_.velocities.rows().middleCols(first, count) = own.velocities.rows();
  }
}

/// Adds to `result`, in m/s^2, what the springs do to the vertices that are not pinned.
void JoinedStep::add_springs(const World& world, const VertexArray& positions,
                             const VertexArray& velocities, VertexArray& result) const {
  const auto push = [&](const SpringEnd& end, const Piece& piece, const Vec3& force) {
    const SoftBody& body = world.soft[at(end.body)];
    const Vec3 change =
        force / (static_cast<double>(end.vertices.size()) * body.material.vertex_mass);
    for (const int v : end.vertices) {
      if (!is_pinned(body, v)) result[piece.first + v] += change;
    }
  };
  for (const Spring& of_group : springs_) {
    const BodySpring& spring = world.springs[of_group.index];
    const Piece& first = pieces_[of_group.first];
    const Piece& second = pieces_[of_group.second];
    const auto between = [&](const VertexArray& values) -> Vec3 {
      return middle(values, spring.second.vertices, second.first) -
             middle(values, spring.first.vertices, first.first);
    };
    const Vec3 pull = spring_pull(spring, between(positions), between(velocities));
    push(spring.first, first, pull);
    push(spring.second, second, -pull);
  }
}

/// Writes dv/dt of all. Returns the smallest volume.
double JoinedStep::accelerations(const World& world, const VertexArray& positions,
                                 const VertexArray& velocities, VertexArray& result) {
  MinVolume smallest;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    Piece& piece = pieces_[i];
    const SoftBody& body = world.soft[at(bodies_[i])];
    const int count = body.positions.size();
    auto out = result.rows().middleCols(piece.first, count);
    if (piece.is_obstacle) {
      out.setZero();
      continue;
    }
    piece.state.positions.rows() = positions.rows().middleCols(piece.first, count);
    piece.state.velocities.rows() = velocities.rows().middleCols(piece.first, count);
    const SoftAcceleration own(*body.mesh, body.material, world.settings.gravity,
                               scratch_[i]->acceleration);
    const double volume = own(piece.state.positions, piece.state.velocities, piece.accelerations);
    for (int v = 0; body.pins && v < count; ++v) {
      if (is_pinned(body, v)) piece.accelerations[v].setZero();
    }
    out = piece.accelerations.rows();
    MinVolume of_body;
    of_body.meet(min_volumes_[i]);
    of_body.meet(volume);
    min_volumes_[i] = of_body.value();
    smallest.meet(volume);
  }
  add_springs(world, positions, velocities, result);
  return smallest.value();
}

void JoinedStep::step_explicitly(World& world, std::span<const SoftState> start) {
  gather(start);
  min_volumes_.assign(pieces_.size(), MinVolume().value());
  const auto acceleration = [&](const VertexArray& positions, const VertexArray& velocities,
                                VertexArray& result) {
    return accelerations(world, positions, velocities, result);
  };
  explicit_step(world.settings.integrator, acceleration, time_step(world.settings), start_,
                end_.positions, end_.velocities, *all_);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    if (pieces_[i].is_obstacle) continue;
    SoftBody& body = world.soft[at(bodies_[i])];
    const auto first = pieces_[i].first, count = body.positions.size();
    body.positions.rows() = end_.positions.rows().middleCols(first, count);
    body.velocities.rows() = end_.velocities.rows().middleCols(first, count);
  }
}

/// The springs alone for a time, in s, in which the positions stand still: by Euler's method, or by
/// that of Heun.
void JoinedStep::kick(const World& world, double seconds, const VertexArray& positions,
                      VertexArray& velocities) {
  changes_.rows().setZero();
  add_springs(world, positions, velocities, changes_);
  if (world.settings.integrator == Integrator::implicit_euler) {
    velocities.rows() += seconds * changes_.rows();
    return;
  }
  predicted_.rows() = velocities.rows() + seconds * changes_.rows();
  add_springs(world, positions, predicted_, changes_);  // of both, twice the mean
  velocities.rows() += 0.5 * seconds * changes_.rows();
}

void JoinedStep::step_implicitly(World& world, std::span<const SoftState> start) {
  gather(start);
  const double step = time_step(world.settings);
  const double after = world.settings.integrator == Integrator::sdirk2 ? 0.5 * step : 0.0;
  kick(world, step - after, start_.positions, start_.velocities);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    Piece& piece = pieces_[i];
    SoftBody& body = world.soft[at(bodies_[i])];
    const int count = body.positions.size();
    auto x = end_.positions.rows().middleCols(piece.first, count);
    auto v = end_.velocities.rows().middleCols(piece.first, count);
    piece.state.positions.rows() = start_.positions.rows().middleCols(piece.first, count);
    piece.state.velocities.rows() = start_.velocities.rows().middleCols(piece.first, count);
    if (piece.is_obstacle) {
      v = piece.state.velocities.rows();
      x = piece.state.positions.rows() + step * v;
      continue;
    }
    min_volumes_[i] =
        implicit_step(*body.mesh, body.material, world.settings, piece.state, body.positions,
                      body.velocities, *scratch_[i]->implicit, body.pins.get())
            .volume;
    x = body.positions.rows();
    v = body.velocities.rows();
  }
  if (after == 0.0) return;
  kick(world, after, end_.positions, end_.velocities);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    if (pieces_[i].is_obstacle) continue;
    VertexArray& velocities = world.soft[at(bodies_[i])].velocities;
    velocities.rows() = end_.velocities.rows().middleCols(pieces_[i].first, velocities.size());
  }
}

}  // namespace pneuma::sim

#include "sim/potential/box_coordinates.h"

#include <cmath>

#include "sim/potential/box_inertia.h"
#include "sim/rigid/inertia.h"
#include "sim/rigid/rigid_motion.h"

namespace pneuma::sim {
namespace {

using Eigen::Quaterniond;

/// Four numbers in two places.
Quaterniond read_four(const VertexArray& from, int vertex) {
  Quaterniond q;
  q.vec() = from[vertex];
  q.w() = from[vertex + 1].x();
  return q;
}

void write_four(const Quaterniond& q, int vertex, VertexArray& to) {
  to[vertex] = q.vec();
  to[vertex + 1] = Vec3(q.w(), 0.0, 0.0);
}

/// w q / 2: of an orientation q how it changes with an angular velocity w in world axes.
Quaterniond half_product(const Vec3& w, const Quaterniond& q) {
  Quaterniond product = Quaterniond(0.0, w.x(), w.y(), w.z()) * q;
  product.coeffs() *= 0.5;
  return product;
}

}  // namespace

BoxCoordinates::BoxCoordinates(const RigidBox& box, int first_vertex, Form form)
    : box_(box),
      first_vertex_(first_vertex),
      form_(form),
      drag_rate_(-60.0 * std::log1p(-box.rho_g)),
      start_turned_(box.orientation) {
  box_.name.clear();  // a copy takes no memory
}

void BoxCoordinates::start(const RigidState& state, VertexArray& positions,
                           VertexArray& velocities) {
  for (VertexArray* values : {&positions, &velocities}) {
    values->rows().middleCols(first_vertex_, box_corners).setZero();
  }
  positions[first_vertex_] = state.position;
  velocities[first_vertex_] = state.velocity;
  const int turn = first_vertex_ + 1;
  if (form_ == Form::momentum) {
    start_turned_ = state.orientation;
    velocities[turn] = spin(box_, state);
    return;
  }
  write_four(state.orientation, turn, positions);
  write_four(half_product(state.angular_velocity, state.orientation), turn, velocities);
}

Quaterniond BoxCoordinates::orientation(const VertexArray& positions) const {
  const int turn = first_vertex_ + 1;
  if (form_ == Form::quaternion) return read_four(positions, turn).normalized();
  return turned_freely(box_, start_turned_, positions[turn], 1.0);
}

RigidState BoxCoordinates::state(const VertexArray& positions,
                                 const VertexArray& velocities) const {
  const int turn = first_vertex_ + 1;
  RigidState state;
  state.position = positions[first_vertex_];
  state.velocity = velocities[first_vertex_];
  state.orientation = orientation(positions);
  if (form_ == Form::momentum) {
    state.angular_velocity = rate_of(box_, state.orientation, velocities[turn]);
  } else {
    const Quaterniond inverse = read_four(positions, turn).inverse();
    state.angular_velocity = 2.0 * (read_four(velocities, turn) * inverse).vec();
  }
  return state;
}

void BoxCoordinates::accelerate(const RigidState& state, const Vec6& force, const Vec3& gravity,
                                VertexArray& acceleration) const {
  const int turn = first_vertex_ + 1;
  acceleration[first_vertex_] = force.head<3>() / box_.mass + gravity - drag_rate_ * state.velocity;
  const Vec3 momentum = spin(box_, state), w = state.angular_velocity;
  const Vec3 torque = force.tail<3>() - drag_rate_ * momentum;
  if (form_ == Form::momentum) {
    acceleration[turn] = torque;
    return;
  }
  const Vec3 change = rate_of(box_, state.orientation, torque - w.cross(momentum));
  Quaterniond second = half_product(change, state.orientation);
  second.coeffs() -= 0.25 * w.squaredNorm() * state.orientation.coeffs();
  write_four(second, turn, acceleration);
}

double BoxCoordinates::mobility(const RigidState& state, const Vec6& force) const {
  const Vec3 torque = force.tail<3>();
  return force.head<3>().squaredNorm() / box_.mass +
         torque.dot(rate_of(box_, state.orientation, torque));
}

}  // namespace pneuma::sim

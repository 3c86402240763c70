#include "sim/swept/impact_side.h"

#include "sim/rigid/inertia.h"
#include "sim/rigid/rigid_motion.h"

namespace pneuma::sim {

ImpactSide::ImpactSide(const RigidBox& box, const RigidState& start, bool moves,
                       const Vec3& gravity, const ImpactFloor& floor)
    : box_(&box),
      floor_(floor),
      gravity_(moves ? gravity : Vec3::Zero()),
      start_(start),
      moves_(moves),
      spin_(spin(box, start)) {
  if (!is_on_floor()) return;
  const Vec3& up = floor.normal;
  borne_gravity_ = up.dot(gravity) * up;
  gravity_ -= borne_gravity_;
  start_.velocity += up.dot(floor.velocity - start.velocity) * up;
  start_.angular_velocity = up.dot(start.angular_velocity) * up;
  spin_ = spin(box, start_);
}

RigidState ImpactSide::after(double duration) const {
  if (moves_) return moved(start_, spin_, 0.0, duration);
  RigidState state = start_;
  state.position += duration * start_.velocity;
  state.orientation = turned(start_.orientation, duration * start_.angular_velocity);
  return state;
}

RigidState ImpactSide::after(const RigidState& from, const BoxChange& change, double since,
                             double time) const {
  RigidState state = from;
  state.velocity += to_vec3(change.velocity);
  state.angular_velocity += to_vec3(change.angular_velocity);
  RigidState result = moved(state, spin(*box_, state), since, time);
  if (leaves_floor(state))
    result.position += 0.5 * (time - since) * (time - since) * borne_gravity_;
  return result;
}

RigidState ImpactSide::moved(const RigidState& from, const Vec3& angular_momentum, double since,
                             double time) const {
  const double duration = time - since;
  RigidState state = from;
  state.position += duration * (from.velocity + 0.5 * (since + time) * gravity_);
  state.orientation = turned_freely(*box_, from.orientation, angular_momentum, duration);
  const Mat3 axes = state.orientation.toRotationMatrix();
  const Vec3 inverse = body_inertia(*box_).cwiseInverse();
  state.angular_velocity = axes * inverse.asDiagonal() * axes.transpose() * angular_momentum;
  return state;
}

double ImpactSide::fastest_turn() const {
  return moves_ ? spin_.norm() / body_inertia(*box_).minCoeff() : start_.angular_velocity.norm();
}

double ImpactSide::height(const RigidState& state, const Vec3& up) const {
  const OrientedBox box = placed(state);
  return up.dot(box.centre) + (box.axes.transpose() * up).cwiseAbs().dot(box.half);
}

OrientedBox ImpactSide::placed(const RigidState& state) const {
  return {state.position, state.orientation.toRotationMatrix(), 0.5 * box_->size};
}

}  // namespace pneuma::sim

#include "sim/swept/free_impact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/collision/box_contact.h"
#include "sim/collision/separating_axis.h"
#include "sim/rigid/inertia.h"
#include "sim/rigid/rigid_motion.h"

namespace pneuma::sim {
namespace {

/// Of what points are hit together within: the separation at the time of impact.
constexpr double time_tolerance = 0.1;
constexpr int max_tries = 100;
/// Of the shortest side: further the sides do not move from one look for an overlap to the next.
constexpr double look_every = 0.25;
constexpr double max_looks = 32;
constexpr double any_distance = std::numeric_limits<double>::infinity();

}  // namespace

ImpactSide::ImpactSide(const RigidBox& box, const RigidState& start, bool moves,
                       const Vec3& gravity)
    : box_(&box), gravity_(gravity), start_(start), moves_(moves), spin_(spin(box, start)) {}

RigidState ImpactSide::after(double duration) const {
  return moves_ ? moved(start_, spin_, 0.0, duration) : start_;
}

RigidState ImpactSide::after(const RigidState& from, const BoxChange& change, double since,
                             double time) const {
  RigidState state = from;
  state.velocity += to_vec3(change.velocity);
  state.angular_velocity += to_vec3(change.angular_velocity);
  return moved(state, spin(*box_, state), since, time);
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
  return moves_ ? spin_.norm() / body_inertia(*box_).minCoeff() : 0.0;
}

OrientedBox ImpactSide::placed(const RigidState& state) const {
  return {state.position, state.orientation.toRotationMatrix(), 0.5 * box_->size};
}

/// Of the sides in free motion: of boxes along the axis that separates them most.
FreeImpact::Separation FreeImpact::separation(double time) const {
  const RigidState first = sides_[0].after(time);
  if (sides_[1].is_ground()) return {sides_[0].bounds(first).low.z(), Vec3::UnitZ()};
  const OrientedBox second = sides_[1].placed(sides_[1].after(time));
  const auto found = find_min_overlap(sides_[0].placed(first), second, any_distance);
  return {-found->overlap, found->normal};
}

/// m/s, at which the sides come nearer to each other along an axis, at most.
double FreeImpact::fastest(const Vec3& axis) const {
  const auto& [first, second] = sides_;
  Vec3 velocity = first.start().velocity;
  double turning = first.fastest_turn() * first.half_diagonal();
  if (second.moves()) {
    velocity -= second.start().velocity;
    turning += second.fastest_turn() * second.half_diagonal();
  }
  return std::max(0.0, -axis.dot(velocity)) + step_ * gravity_.norm() + turning;
}

/// By conservative advancement: to where the sides cannot meet before (Mirtich 1996).
FreeImpact::Result FreeImpact::find_time() {
  const double tolerance = time_tolerance * together_;
  Separation between = separation(0.0);
  double apart = between.distance - wanted_;
  if (apart < 0.0) return Result::none;
  for (int i = 0; i < max_tries && apart > tolerance && time_ < step_; ++i) {
    time_ = std::min(step_, time_ + apart / fastest(between.axis));
    between = separation(time_);
    apart = between.distance - wanted_;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (!sides_[i].is_ground()) states_[i] = sides_[i].after(time_);
  }
  if (apart <= tolerance) return Result::hit;
  return time_ < step_ ? Result::none : Result::pass;
}

/// Calls `visit(point, normal)` for the points in which the sides are no further apart than
/// `reach` (m).
template <class Visit>
void FreeImpact::for_each_near(const std::array<RigidState, 2>& states, double reach,
                               const Visit& visit) const {
  const OrientedBox first = sides_[0].placed(states[0]);
  if (sides_[1].is_ground()) {
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner = first.corner(i);
      if (corner.z() <= reach) visit(corner, Vec3::UnitZ());
    }
    return;
  }
  const auto contact = find_box_contact_within(reach, first, sides_[1].placed(states[1]));
  if (!contact) return;
  for (const BoxContactPoint& point : contact->points()) {
    if (-point.depth <= reach) visit(point.point, contact->normal);
  }
}

bool FreeImpact::find_points(const ContactMaterial& material, std::vector<SweptImpulse>& impulses,
                             std::vector<ImpactPoint>& points) {
  impulses.clear();
  points.clear();
  for (std::size_t i = 0; i < 2; ++i) {
    if (!sides_[i].moves()) continue;
    changes_[i] = make_box_change(sides_[i].box(), states_[i].position, states_[i].orientation);
  }
  bool all_bounce = true;
  for_each_near(states_, wanted_ + together_, [&](const Vec3& at, const Vec3& normal) {
    const Vec3 velocity = velocity_at(at, states_) + time_ * gravity_;
    const double approach = -normal.dot(velocity);
    all_bounce = all_bounce && material.restitution * approach >= min_bounce_speed;
    impulses.emplace_back(side(0, at), side(1, at), normal, material.friction);
    points.push_back({.velocity = velocity, .speed = -approach, .approach = approach, .at = at});
  });
  for (std::size_t i = 0; i < points.size(); ++i) points[i].impulse = &impulses[i];
  return all_bounce && !points.empty();
}

SweptSide FreeImpact::side(std::size_t i, const Vec3& point) {
  return sides_[i].moves() ? SweptSide(changes_[i], point) : SweptSide();
}

/// m/s, of the first side against the second.
Vec3 FreeImpact::velocity_at(const Vec3& point, const std::array<RigidState, 2>& states) const {
  const auto of = [&](std::size_t side) -> Vec3 {
    if (!sides_[side].moves()) return Vec3::Zero();
    const RigidState& state = states[side];
    return state.velocity + state.angular_velocity.cross(point - state.position);
  };
  return of(0) - of(1);
}

void FreeImpact::finish(std::span<const ImpactPoint> points) {
  for (const ImpactPoint& point : points) work_ += point.impulse->work(point.velocity);
  for (std::size_t i = 0; i < 2; ++i) {
    ends_[i] =
        sides_[i].moves() ? sides_[i].after(states_[i], changes_[i], time_, step_) : states_[i];
  }
}

/// m, by which the sides move against each other in the time left, at most.
double FreeImpact::motion_left() const {
  const auto& [first, second] = sides_;
  Vec3 velocity = ends_[0].velocity;
  if (second.moves()) velocity -= ends_[1].velocity;
  double turned = first.half_diagonal() * ends_[0].angular_velocity.norm();
  if (second.moves()) turned += second.half_diagonal() * ends_[1].angular_velocity.norm();
  return time_left() * (velocity.norm() + step_ * gravity_.norm() + turned);
}

/// `duration`: s, since the impact.
bool FreeImpact::overlap_after(double duration) const {
  const auto placed = [&](std::size_t i) {
    return sides_[i].placed(sides_[i].moves()
                                ? sides_[i].after(states_[i], changes_[i], time_, time_ + duration)
                                : states_[i]);
  };
  return find_box_contact(placed(0), placed(1)).has_value();
}

bool FreeImpact::meets_again(double near) const {
  if (sides_[1].is_ground()) {
    if (sides_[0].bounds(ends_[0]).low.z() < 0.0) return true;
  } else {
    const double thinnest =
        std::min(sides_[0].box().size.minCoeff(), sides_[1].box().size.minCoeff());
    const double looks = std::ceil(motion_left() / (look_every * thinnest));
    if (looks > max_looks) return true;
    for (int i = 1; i <= looks; ++i) {
      if (overlap_after(time_left() * i / looks)) return true;
    }
  }
  bool approaches = false;
  for_each_near(ends_, near, [&](const Vec3& at, const Vec3& normal) {
    approaches = approaches || normal.dot(velocity_at(at, ends_) + step_ * gravity_) < 0.0;
  });
  return approaches;
}

}  // namespace pneuma::sim

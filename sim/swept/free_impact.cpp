#include "sim/swept/free_impact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/collision/box_contact.h"
#include "sim/collision/separating_axis.h"

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
  if (!second.is_ground()) {
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
  if (apart < -together_) return Result::none;
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

bool FreeImpact::find_points(double friction, std::vector<SweptImpulse>& impulses,
                             std::vector<ImpactPoint>& points) {
  impulses.clear();
  points.clear();
  for (std::size_t i = 0; i < 2; ++i) {
    if (!sides_[i].moves()) continue;
    changes_[i] = make_box_change(sides_[i].box(), states_[i].position, states_[i].orientation);
  }
  bool any_hit = false;
  for_each_near(states_, wanted_ + together_, [&](const Vec3& at, const Vec3& normal) {
    const Vec3 velocity = velocity_at(at, states_) + time_ * gravity_;
    const double speed = normal.dot(velocity), approach = std::max(0.0, -speed);
    any_hit = any_hit || approach > 0.0;
    impulses.emplace_back(side(0, at), side(1, at), normal, friction);
    points.push_back(
        {.velocity = velocity,
         .speed = speed,
         .approach = approach,
         .at = at,
         .driven = sides_[1].moves() ? Vec3(Vec3::Zero()) : velocity_of(1, at, states_[1])});
  });
  for (std::size_t i = 0; i < 2; ++i) {
    if (any_hit && sides_[i].is_on_floor()) add_floor(i, impulses, points);
  }
  for (std::size_t i = 0; i < points.size(); ++i) points[i].impulse = &impulses[i];
  return any_hit;
}

void FreeImpact::add_floor(std::size_t i, std::vector<SweptImpulse>& impulses,
                           std::vector<ImpactPoint>& points) {
  const ImpactFloor& floor = sides_[i].floor();
  for (const Vec3& local : std::span(floor.points).first(floor.count)) {
    const Vec3 at = states_[i].position + states_[i].orientation * local;
    const Vec3 velocity =
        velocity_of(i, at, states_[i]) + time_ * sides_[i].gravity() - floor.velocity;
    impulses.emplace_back(side(i, at), SweptSide(), floor.normal, floor.friction);
    points.push_back({.velocity = velocity,
                      .speed = floor.normal.dot(velocity),
                      .at = at,
                      .driven = floor.velocity});
  }
}

SweptSide FreeImpact::side(std::size_t i, const Vec3& point) {
  return sides_[i].moves() ? SweptSide(changes_[i], point) : SweptSide();
}

/// m/s.
Vec3 FreeImpact::velocity_of(std::size_t i, const Vec3& point, const RigidState& state) const {
  if (sides_[i].is_ground()) return Vec3::Zero();
  return state.velocity + state.angular_velocity.cross(point - state.position);
}

/// m/s, of the first side against the second.
Vec3 FreeImpact::velocity_at(const Vec3& point, const std::array<RigidState, 2>& states) const {
  return velocity_of(0, point, states[0]) - velocity_of(1, point, states[1]);
}

void FreeImpact::finish(std::span<const ImpactPoint> points) {
  for (const ImpactPoint& point : points) {
    work_ += point.impulse->work(point.velocity);
    driven_work_ += point.impulse->given().dot(point.driven);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (!sides_[i].is_ground()) ends_[i] = after_impact(i, step_);
  }
}

/// `time`: s, since the start of the step.
RigidState FreeImpact::after_impact(std::size_t i, double time) const {
  return sides_[i].moves() ? sides_[i].after(states_[i], changes_[i], time_, time)
                           : sides_[i].after(time);
}

/// m, by which the sides move against each other in the time left, at most.
double FreeImpact::motion_left() const {
  const auto& [first, second] = sides_;
  const Vec3 velocity = ends_[0].velocity - ends_[1].velocity;
  const double turned = first.half_diagonal() * ends_[0].angular_velocity.norm() +
                        second.half_diagonal() * ends_[1].angular_velocity.norm();
  return time_left() * (velocity.norm() + step_ * gravity_.norm() + turned);
}

/// `duration`: s, since the impact.
bool FreeImpact::overlap_after(double duration) const {
  const auto placed = [&](std::size_t i) {
    return sides_[i].placed(after_impact(i, time_ + duration));
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

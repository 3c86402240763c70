// The part of SweptSearch that finds boxes between walls that leave less room than they would keep
// from both.
#include <algorithm>
#include <utility>

#include "sim/step/swept/between_walls.h"
#include "sim/step/swept/swept_search.h"
#include "sim/step/swept/wall_sides.h"

namespace pneuma::sim {
namespace {

/// Of boxes: of a longer one those in the middle may not know of both walls.
constexpr int longest_row = 64;
/// Of the distance up to which they are in contact: walls that leave less squeeze the box.
constexpr double least_room = 0.01;
/// Of the speed of the faster one, and m/s: walls that slide across each other by more cannot both
/// hold the box, which would tilt into them.
constexpr double allowed_slide = 0.05, least_slide = 1e-3;
/// m/s: walls that move against each other by no more hold the box, and share that among the gaps.
constexpr double as_one = 0.01;

int other_of(const BodyPair& bodies, int one) {
  return bodies.first == one ? bodies.second : bodies.first;
}

WallBeside& wall_beside(std::span<WallsBeside> walls, const BoxSide& side, bool is_positive) {
  auto& [below, above] = walls[at(side.box)].along[at(side.axis)];
  return is_positive ? above : below;
}

/// What is beyond the second box is beyond the first as well. Returns whether it is nearer there
/// than what was.
bool pass_on(std::span<WallsBeside> walls, const BoxesInRow& pair, double mass_of_second) {
  const WallBeside& beyond = wall_beside(walls, pair.second, !pair.second.is_positive);
  WallBeside& wall = wall_beside(walls, pair.first, pair.first.is_positive);
  const double distance = pair.distance + beyond.distance;
  if (!(distance < wall.distance)) return false;
  wall = {.distance = distance,
          .middle = pair.middle + beyond.middle,
          .near = std::min(pair.near, beyond.near),
          .gaps = beyond.gaps + 1,
          .mass = beyond.mass + mass_of_second,
          .body = beyond.body};
  return true;
}

double near_distance(const WallBeside& below, const WallBeside& above) {
  return std::min(below.near, above.near);
}

/// Whether all contacts between them may press at once, which nothing but friction asks for. The
/// ground alone is no two walls.
bool leave_little(const WallBeside& below, const WallBeside& above) {
  if (below.body == swept_ground && above.body == swept_ground) return false;
  return room_between(below, above) < (below.gaps + above.gaps) * near_distance(below, above);
}

/// A bit for each. `is(below, above, axis)`.
template <class Is>
std::uint8_t axes_where(const WallsBeside& walls, const Is& is) {
  std::uint8_t axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& [below, above] = walls.along[at(axis)];
    if (is(below, above, axis)) axes |= static_cast<std::uint8_t>(1 << axis);
  }
  return axes;
}

}  // namespace

void SweptSearch::find_boxes_between_walls() {
  m_.between_walls.assign(world_.rigid.size(), 0);
  m_.squeezed.assign(world_.rigid.size(), 0);
  m_.held.assign(world_.rigid.size(), 0);
  if (world_.rigid.empty() || !find_walls_beside()) return;
  find_walls_beyond_rows();
  for (std::size_t i = 0; i < world_.rigid.size(); ++i) {
    m_.between_walls[i] = axes_where(
        m_.walls_beside[i],
        [](const auto& below, const auto& above, int) { return leave_little(below, above); });
    if (m_.between_walls[i] == 0) continue;
    const Mat3& axes = bodies_.start_axes(bodies_.of_box(static_cast<int>(i)));
    const RigidBox& box = world_.rigid[i];
    m_.squeezed[i] =
        axes_where(m_.walls_beside[i], [&](const auto& below, const auto& above, int axis) {
          return squeeze(below, above, axes.col(axis), box.position);
        });
    m_.held[i] = m_.squeezed[i] &
                 axes_where(m_.walls_beside[i], [&](const auto& below, const auto& above, int) {
                   return hold(below, above, box);
                 });
  }
  release_what_is_driven_into_others();
}

/// What walls drive into something else, with all their force, slips: held to them as well, it
/// would be thrown by what the solution of such forces leaves.
void SweptSearch::release_what_is_driven_into_others() {
  if (std::ranges::all_of(m_.held, [](std::uint8_t axes) { return axes == 0; })) return;
  m_.without_hold.clear();
  for (const SweptCandidate& candidate : m_.candidates) {
    const int body = box_beside_wall(world_, m_, candidate.bodies);
    if (body < 0 || m_.held[at(bodies_.box(body))] == 0) continue;
    const Vec3 normal = places_.start_normal(candidate);
    if (walls_along(world_, m_, m_.held, candidate.bodies, normal)) continue;
    const RigidBox& box = world_.rigid[at(bodies_.box(body))];
    const int other = other_of(candidate.bodies, body);
    const Vec3 away = body == candidate.bodies.first ? normal : Vec3(-normal);
    const Vec3 beside = velocity_of_wall(world_, m_, other, box.position).linear;
    for (int axis = 0; axis < 3; ++axis) {
      if ((m_.held[at(bodies_.box(body))] >> axis & 1) == 0) continue;
      const auto& [below, above] = m_.walls_beside[at(bodies_.box(body))].along[at(axis)];
      const Vec3 driven = velocity_of_wall(world_, m_, below.body, box.position).linear;
      if (away.dot(driven - beside) < -least_slide) {
        m_.without_hold.push_back({below.body, above.body});
      }
    }
  }
  if (m_.without_hold.empty()) return;
  for (std::size_t i = 0; i < m_.held.size(); ++i) {
    m_.held[i] &= axes_where(m_.walls_beside[i], [&](const auto& below, const auto& above, int) {
      const BodyPair walls{below.body, above.body};
      return std::ranges::find(m_.without_hold, walls) == m_.without_hold.end();
    });
  }
}

/// Returns whether there are any, besides the ground.
bool SweptSearch::find_walls_beside() {
  bool any_walls = false;
  for (const SweptCandidate& candidate : m_.candidates) {
    const bool on_ground = candidate.bodies.second == swept_ground;
    if (on_ground && !any_walls) return false;  // the ground comes last
    const int box = box_beside_wall(world_, m_, candidate.bodies);
    if (box < 0) continue;
    const auto side = side_of_wall(m_, candidate.bodies, box, places_.start_normal(candidate));
    if (!side) continue;
    if (!any_walls) m_.walls_beside.assign(world_.rigid.size(), WallsBeside{});
    any_walls = true;
    WallBeside& wall = wall_beside(m_.walls_beside, *side, side->is_positive);
    const double distance = places_.start_distance(candidate);
    if (distance < wall.distance) {
      wall.distance = distance;
      wall.middle = middle_distance(candidate);
      wall.body = other_of(candidate.bodies, box);
    }
    if (on_ground) continue;
    wall.near =
        std::min(wall.near, motion_.near_distance(candidate.bodies.first, candidate.bodies.second));
  }
  return any_walls;
}

/// From box to box, until nothing changes.
void SweptSearch::find_walls_beyond_rows() {
  m_.rows.clear();
  for (const SweptCandidate& candidate : m_.candidates) {
    const BodyPair& bodies = candidate.bodies;
    if (!candidate.is_of_near_boxes || !are_free_boxes(world_, m_, bodies)) continue;
    const auto first = side_of_wall(m_, bodies, bodies.first, candidate.normal);
    const auto second = side_of_wall(m_, bodies, bodies.second, candidate.normal);
    if (!first || !second) continue;
    m_.rows.push_back({*first, *second, candidate.start.distance, middle_distance(candidate),
                       motion_.near_distance(bodies.first, bodies.second)});
  }
  bool any_passed = true;
  for (int i = 0; any_passed && i < longest_row; ++i) {
    any_passed = false;
    for (const BoxesInRow& pair : m_.rows) {
      const BoxesInRow back{pair.second, pair.first, pair.distance, pair.middle, pair.near};
      for (const BoxesInRow& row : {pair, back}) {
        const double mass = world_.rigid[at(row.second.box)].mass;
        any_passed = pass_on(m_.walls_beside, row, mass) || any_passed;
      }
    }
  }
}

/// m, between the faces of two boxes, or of one and a wall or the ground, in their middles: a row
/// that sags touches with corners, and is longer than its boxes are.
double SweptSearch::middle_distance(const SweptCandidate& candidate) const {
  const auto [first, second] = candidate.bodies;
  const Vec3 normal = places_.start_normal(candidate);
  const auto half_along = [&](int body) {
    const auto side = side_of_wall(m_, candidate.bodies, body, normal);
    return side ? places_.start_box(body).half[side->axis] : 0.0;
  };
  if (second == swept_ground) return places_.start_box(first).centre.z() - half_along(first);
  if (!bodies_.is_box(first) || !bodies_.is_box(second)) return candidate.start.distance;
  const int face = is_kinematic(world_, first) ? first : second;  // of a wall, however wide
  const auto side = side_of_wall(m_, candidate.bodies, face, normal);
  const Vec3 axis = side ? Vec3(bodies_.start_axes(face).col(side->axis)) : normal;
  const Vec3 way = places_.start_box(first).centre - places_.start_box(second).centre;
  return std::abs(axis.dot(way)) - half_along(first) - half_along(second);
}

/// Whether such walls leave no room to the box at `middle` on the axis: one of them is moved, and
/// they do not slide across each other. Of models that are moved no box is squeezed: they meet it
/// from outside, or stop the run.
bool SweptSearch::squeeze(const WallBeside& below, const WallBeside& above, const Vec3& axis,
                          const Vec3& middle) const {
  if (below.middle + above.middle >= least_room * near_distance(below, above)) return false;
  const auto is_moved = [&](int body) {
    return body != swept_ground && bodies_.is_box(body) && bodies_.pushes(body);
  };
  if (!is_moved(below.body) && !is_moved(above.body)) return false;
  const Vec3 one = velocity_of_wall(world_, m_, below.body, middle).linear;
  const Vec3 other = velocity_of_wall(world_, m_, above.body, middle).linear;
  const Vec3 apart = one - other;
  const double speed = std::max(one.norm(), other.norm());
  return (apart - axis.dot(apart) * axis).norm() <= allowed_slide * speed + least_slide;
}

/// Whether they move as one, or nearly, where the box is.
bool SweptSearch::hold(const WallBeside& below, const WallBeside& above,
                       const RigidBox& box) const {
  const WallVelocity one = velocity_of_wall(world_, m_, below.body, box.position);
  const WallVelocity other = velocity_of_wall(world_, m_, above.body, box.position);
  return (one.linear - other.linear).norm() <= as_one &&
         (one.angular - other.angular).norm() * 0.5 * box.size.norm() <= as_one;
}

std::optional<double> SweptSearch::kept_between_walls(const SweptCandidate& candidate,
                                                      double wanted) const {
  if (!may_be_between_walls(m_, candidate.bodies)) return std::nullopt;
  return sim::kept_between_walls(world_, m_, candidate.bodies, places_.start_normal(candidate),
                                 wanted);
}

bool SweptSearch::is_squeezed(const SweptCandidate& candidate) const {
  return squeezed_box(world_, m_, candidate.bodies) >= 0 &&
         sim::is_squeezed(world_, m_, candidate.bodies, places_.start_normal(candidate));
}

}  // namespace pneuma::sim

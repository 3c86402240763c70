// The part of SweptSearch that finds boxes between walls that leave less room than they would keep
// from both.
#include "sim/step/swept/between_walls.h"

#include <algorithm>
#include <optional>

#include "sim/step/swept/swept_search.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// Cosine of the angle up to which a wall is beside a side of the box.
constexpr double cosine_of_side = 0.9;
/// m/s^2, of the mass of a box: so much presses each of its contacts with walls that squeeze it. By
/// the usual friction that holds some eighty times its weight.
constexpr double squeeze_of_mass = 200.0;
/// Of the distance up to which they are in contact: walls that leave less squeeze the box.
constexpr double least_room = 0.01;
/// Of the speed of the faster one, and m/s: walls that slide across each other by more cannot both
/// hold the box, which would tilt into them.
constexpr double allowed_slide = 0.05, least_slide = 1e-3;

/// A side of a free box.
struct BoxSide {
  int box = 0;
  int axis = 0;
  bool is_positive = false;
};

/// Which of two bodies is a free box, and the other a wall or the ground; -1 if none is.
int box_beside_wall(const World& world, const SweptMemory& memory, const BodyPair& bodies) {
  const auto is_wall = [&](int body) { return body == swept_ground || is_kinematic(world, body); };
  const auto [first, second] = bodies;
  if (is_wall(first) == is_wall(second)) return -1;
  const int body = is_wall(first) ? second : first;
  return memory.bodies.is_box(body) ? body : -1;
}

int other_of(const BodyPair& bodies, int one) {
  return bodies.first == one ? bodies.second : bodies.first;
}

/// On which side of the box the other is. `normal`: from the second to the first.
std::optional<BoxSide> side_of_wall(const SweptMemory& memory, const BodyPair& bodies, int box,
                                    const Vec3& normal) {
  const Vec3 to_wall = box == bodies.first ? Vec3(-normal) : normal;
  const Vec3 along = memory.bodies.start_axes(box).transpose() * to_wall;
  int axis = 0;
  if (along.cwiseAbs().maxCoeff(&axis) < cosine_of_side) return std::nullopt;
  return BoxSide{memory.bodies.box(box), axis, along[axis] > 0.0};
}

/// They leave less than this part of the distance up to which they are in contact with the box.
bool leave_less(const WallBeside& below, const WallBeside& above, double part) {
  return below.distance + above.distance < part * std::min(below.near, above.near);
}

/// `along`: the axis of the box on which they are.
bool squeeze(const WallBeside& below, const WallBeside& above, const Vec3& along) {
  if (!leave_less(below, above, least_room) || !(below.is_moved || above.is_moved)) return false;
  const Vec3 apart = below.velocity - above.velocity;
  const double speed = std::max(below.velocity.norm(), above.velocity.norm());
  return (apart - along.dot(apart) * along).norm() <= allowed_slide * speed + least_slide;
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

/// Whether one of two bodies is a free box, and the other a wall or the ground on one of the `axes`
/// of each box.
bool is_wall_along(const World& world, const SweptMemory& memory,
                   std::span<const std::uint8_t> axes, const BodyPair& bodies, const Vec3& normal) {
  const int box = box_beside_wall(world, memory, bodies);
  if (box < 0) return false;
  const auto side = side_of_wall(memory, bodies, box, normal);
  return side && (axes[at(side->box)] >> side->axis & 1) != 0;
}

}  // namespace

void SweptSearch::find_boxes_between_walls() {
  m_.between_walls.assign(world_.rigid.size(), 0);
  m_.squeezed.assign(world_.rigid.size(), 0);
  if (world_.rigid.empty()) return;
  bool any_walls = false;
  for (const SweptCandidate& candidate : m_.candidates) {
    const bool on_ground = candidate.bodies.second == swept_ground;
    if (on_ground && !any_walls) return;  // the ground comes last
    const int box = box_beside_wall(world_, m_, candidate.bodies);
    if (box < 0) continue;
    const auto side = side_of_wall(m_, candidate.bodies, box, places_.start_normal(candidate));
    if (!side) continue;
    if (!any_walls) m_.walls_beside.assign(world_.rigid.size(), WallsBeside{});
    any_walls = true;
    auto& [below, above] = m_.walls_beside[at(side->box)].along[at(side->axis)];
    WallBeside& wall = side->is_positive ? above : below;
    const double distance = places_.start_distance(candidate);
    if (distance < wall.distance) {
      wall.distance = distance;
      look_at(other_of(candidate.bodies, box), box, wall);
    }
    if (on_ground) continue;
    wall.near =
        std::min(wall.near, motion_.near_distance(candidate.bodies.first, candidate.bodies.second));
  }
  if (!any_walls) return;
  for (std::size_t i = 0; i < world_.rigid.size(); ++i) {
    m_.between_walls[i] = axes_where(
        m_.walls_beside[i],
        [](const auto& below, const auto& above, int) { return leave_less(below, above, 1.0); });
    if (m_.between_walls[i] == 0) continue;
    const Mat3& axes = bodies_.start_axes(bodies_.of_box(static_cast<int>(i)));
    m_.squeezed[i] =
        axes_where(m_.walls_beside[i], [&](const auto& below, const auto& above, int axis) {
          return squeeze(below, above, axes.col(axis));
        });
  }
}

/// Of models that are moved no box is squeezed: they meet it from outside, or stop the run.
void SweptSearch::look_at(int body, int box, WallBeside& wall) const {
  wall.is_moved = body != swept_ground && bodies_.is_box(body) && bodies_.pushes(body);
  wall.velocity.setZero();
  if (!wall.is_moved) return;
  const RigidBox& moved = world_.rigid[at(bodies_.box(body))];
  const Vec3 arm = world_.rigid[at(bodies_.box(box))].position - moved.position;
  wall.velocity = moved.velocity + moved.angular_velocity.cross(arm);
}

bool SweptSearch::is_between_walls(const SweptCandidate& candidate) const {
  return may_be_between_walls(m_, candidate.bodies) &&
         sim::is_between_walls(world_, m_, candidate.bodies, places_.start_normal(candidate));
}

bool SweptSearch::is_squeezed(const SweptCandidate& candidate) const {
  return squeezed_box(world_, m_, candidate.bodies) >= 0 &&
         sim::is_squeezed(world_, m_, candidate.bodies, places_.start_normal(candidate));
}

bool may_be_between_walls(const SweptMemory& memory, const BodyPair& bodies) {
  const auto is_between = [&](int body) {
    return body != swept_ground && memory.bodies.is_rigid(body) &&
           memory.between_walls[at(memory.bodies.box(body))] != 0;
  };
  return bodies.second != swept_ground && (is_between(bodies.first) || is_between(bodies.second));
}

bool is_between_walls(const World& world, const SweptMemory& memory, const BodyPair& bodies,
                      const Vec3& normal) {
  return may_be_between_walls(memory, bodies) &&
         is_wall_along(world, memory, memory.between_walls, bodies, normal);
}

int squeezed_box(const World& world, const SweptMemory& memory, const BodyPair& bodies) {
  if (memory.squeezed.empty()) return -1;
  const int box = box_beside_wall(world, memory, bodies);
  return box >= 0 && memory.squeezed[at(memory.bodies.box(box))] != 0 ? box : -1;
}

bool is_squeezed(const World& world, const SweptMemory& memory, const BodyPair& bodies,
                 const Vec3& normal) {
  return squeezed_box(world, memory, bodies) >= 0 &&
         is_wall_along(world, memory, memory.squeezed, bodies, normal);
}

double squeeze_between_walls(const World& world, const SweptMemory& memory,
                             const SweptContact& contact) {
  const int box = squeezed_box(world, memory, pair_of(contact));
  if (box < 0 || !is_squeezed(world, memory, pair_of(contact), contact.normal)) return 0.0;
  return squeeze_of_mass * world.rigid[at(memory.bodies.box(box))].mass;
}

}  // namespace pneuma::sim

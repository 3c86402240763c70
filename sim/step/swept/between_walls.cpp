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
/// the usual friction that holds some hundred times its weight.
constexpr double squeeze_of_mass = 200.0;

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

bool leave_little_room(const WallBeside& below, const WallBeside& above) {
  return below.distance + above.distance < std::min(below.near, above.near);
}

bool squeeze(const WallBeside& below, const WallBeside& above) {
  return below.distance + above.distance < rounding_distance && (below.is_moved || above.is_moved);
}

/// A bit for each.
template <class Is>
std::uint8_t axes_where(const WallsBeside& walls, const Is& is) {
  std::uint8_t axes = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& [below, above] = walls.along[axis];
    if (is(below, above)) axes |= static_cast<std::uint8_t>(1 << axis);
  }
  return axes;
}

/// Whether the axis along which the other is beside the box is one of those.
bool is_along(std::span<const std::uint8_t> axes, const BoxSide& side) {
  return (axes[at(side.box)] >> side.axis & 1) != 0;
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
      wall.is_moved = !on_ground && bodies_.pushes(other_of(candidate.bodies, box));
    }
    if (on_ground) continue;
    wall.near =
        std::min(wall.near, motion_.near_distance(candidate.bodies.first, candidate.bodies.second));
  }
  if (!any_walls) return;
  for (std::size_t i = 0; i < world_.rigid.size(); ++i) {
    m_.between_walls[i] = axes_where(m_.walls_beside[i], leave_little_room);
    m_.squeezed[i] = axes_where(m_.walls_beside[i], squeeze);
  }
}

bool SweptSearch::is_between_walls(const SweptCandidate& candidate) const {
  return may_be_between_walls(m_, candidate.bodies) &&
         sim::is_between_walls(world_, m_, candidate.bodies, places_.start_normal(candidate));
}

bool SweptSearch::is_squeezed(const SweptCandidate& candidate) const {
  return sim::is_squeezed(world_, m_, candidate.bodies, places_.start_normal(candidate));
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
  if (!may_be_between_walls(memory, bodies)) return false;
  const int box = box_beside_wall(world, memory, bodies);
  if (box < 0) return false;
  const auto side = side_of_wall(memory, bodies, box, normal);
  return side && is_along(memory.between_walls, *side);
}

bool is_squeezed(const World& world, const SweptMemory& memory, const BodyPair& bodies,
                 const Vec3& normal) {
  if (memory.squeezed.empty()) return false;
  const int box = box_beside_wall(world, memory, bodies);
  if (box < 0 || memory.squeezed[at(memory.bodies.box(box))] == 0) return false;
  const auto side = side_of_wall(memory, bodies, box, normal);
  return side && is_along(memory.squeezed, *side);
}

double squeeze_between_walls(const World& world, const SweptMemory& memory,
                             const SweptContact& contact) {
  if (!is_squeezed(world, memory, pair_of(contact), contact.normal)) return 0.0;
  const int box = box_beside_wall(world, memory, pair_of(contact));
  return squeeze_of_mass * world.rigid[at(memory.bodies.box(box))].mass;
}

}  // namespace pneuma::sim

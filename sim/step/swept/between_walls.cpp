#include "sim/step/swept/between_walls.h"

#include <algorithm>
#include <optional>

#include "sim/step/swept/contact_places.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// Cosine of the angle up to which a wall is beside a side of the box.
constexpr double cosine_of_side = 0.9;

/// A side of a free box.
struct BoxSide {
  int box = 0;
  int axis = 0;
  bool is_positive = false;
};

std::optional<BoxSide> side_towards(const SweptMemory& memory, int body, const Vec3& to_wall) {
  if (!memory.bodies.is_box(body)) return std::nullopt;
  const Vec3 along = memory.bodies.start_axes(body).transpose() * to_wall;
  int axis = 0;
  if (along.cwiseAbs().maxCoeff(&axis) < cosine_of_side) return std::nullopt;
  return BoxSide{memory.bodies.box(body), axis, along[axis] > 0.0};
}

/// On which side of a box the wall is, if one is a free box and the other a wall.
std::optional<BoxSide> side_of_wall(const World& world, const SweptMemory& memory,
                                    const BodyPair& bodies, const Vec3& normal) {
  const auto [first, second] = bodies;
  const bool first_is_wall = is_kinematic(world, first);
  if (second == swept_ground || first_is_wall == is_kinematic(world, second)) return std::nullopt;
  return first_is_wall ? side_towards(memory, second, normal)
                       : side_towards(memory, first, -normal);
}

class BetweenWalls {
 public:
  BetweenWalls(const World& world, const ContactMotion& motion, SweptMemory& memory)
      : world_(world), motion_(motion), m_(memory) {}

  void find() {
    m_.between_walls.assign(world_.rigid.size(), 0);
    if (world_.rigid.empty()) return;
    bool any_walls = false;
    for (const SweptCandidate& candidate : m_.candidates) {
      const bool on_ground = candidate.bodies.second == swept_ground;
      if (on_ground && !any_walls) return;  // the ground comes last
      const auto side = on_ground
                            ? side_towards(m_, candidate.bodies.first, -Vec3::UnitZ())
                            : side_of_wall(world_, m_, candidate.bodies, normal_of(candidate));
      if (!side) continue;
      if (!any_walls) m_.walls_beside.assign(world_.rigid.size(), WallsBeside{});
      any_walls = true;
      note(*side, candidate);
    }
    if (!any_walls) return;
    for (std::size_t box = 0; box < m_.walls_beside.size(); ++box) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto& [below, above] = m_.walls_beside[box].along[axis];
        const bool is_between = below.distance + above.distance < std::min(below.near, above.near);
        if (is_between) m_.between_walls[box] |= static_cast<std::uint8_t>(1 << axis);
      }
    }
  }

 private:
  void note(const BoxSide& side, const SweptCandidate& candidate) {
    const auto [first, second] = candidate.bodies;
    auto& [below, above] = m_.walls_beside[at(side.box)].along[at(side.axis)];
    WallBeside& wall = side.is_positive ? above : below;
    const bool on_ground = second == swept_ground;
    const double distance = on_ground
                                ? m_.bodies.surface(first).start[candidate.features.first.index].z()
                                : candidate.start.distance;
    wall.distance = std::min(wall.distance, distance);
    if (!on_ground) wall.near = std::min(wall.near, motion_.near_distance(first, second));
  }

  const World& world_;
  const ContactMotion& motion_;
  SweptMemory& m_;
};

}  // namespace

void find_boxes_between_walls(const World& world, const ContactMotion& motion,
                              SweptMemory& memory) {
  BetweenWalls(world, motion, memory).find();
}

bool is_between_walls(const World& world, const SweptMemory& memory, const BodyPair& bodies,
                      const Vec3& normal) {
  const auto is_between = [&](int body) {
    return body != swept_ground && memory.bodies.is_rigid(body) &&
           memory.between_walls[at(memory.bodies.box(body))] != 0;
  };
  if (!is_between(bodies.first) && !is_between(bodies.second)) return false;
  const auto side = side_of_wall(world, memory, bodies, normal);
  return side && (memory.between_walls[at(side->box)] >> side->axis & 1) != 0;
}

}  // namespace pneuma::sim

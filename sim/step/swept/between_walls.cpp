#include "sim/step/swept/between_walls.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/step/swept/contact_places.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// Cosine of the angle up to which a wall is beside a side of the box.
constexpr double cosine_of_side = 0.9;

constexpr std::uint8_t side(int axis, bool is_positive) {
  return static_cast<std::uint8_t>(1 << (2 * axis + (is_positive ? 1 : 0)));
}
constexpr std::uint8_t far_side(std::uint8_t side) {
  constexpr std::uint8_t negative = 0b010101;
  return static_cast<std::uint8_t>((side & negative) != 0 ? side << 1 : side >> 1);
}

struct Wall {
  int box = 0;
  std::uint8_t side = 0;
};

class BetweenWalls {
 public:
  BetweenWalls(const World& world, const ContactMotion& motion, SweptMemory& memory)
      : world_(world), motion_(motion), m_(memory) {}

  void find() {
    m_.between_walls.clear();
    m_.walls_beside.assign(world_.rigid.size(), 0);
    bool any_walls = false;
    for (const SweptCandidate& candidate : m_.candidates) {
      const auto wall = wall_of(candidate);
      if (!wall) continue;
      m_.walls_beside[at(wall->box)] |= wall->side;
      any_walls = true;
    }
    if (!any_walls) return;
    for (const SweptCandidate& candidate : m_.candidates) {
      if (!m_.between_walls.empty() && m_.between_walls.back() == candidate.bodies) continue;
      const auto wall = wall_of(candidate);
      if (!wall || (m_.walls_beside[at(wall->box)] & far_side(wall->side)) == 0) continue;
      m_.between_walls.push_back(candidate.bodies);
    }
  }

 private:
  /// Beside which of its sides a free box has a wall.
  std::optional<Wall> wall_of(const SweptCandidate& candidate) const {
    const auto [first, second] = candidate.bodies;
    if (second == swept_ground) return std::nullopt;
    const bool first_is_wall = is_kinematic(world_, first);
    if (first_is_wall == is_kinematic(world_, second)) return std::nullopt;
    const int body = first_is_wall ? second : first;
    if (!m_.bodies.is_box(body)) return std::nullopt;
    const double distance = candidate.start.distance;
    if (distance >= motion_.distance_wanted(first, second)) return std::nullopt;
    Vec3 normal = candidate.normal;
    if (!candidate.is_of_near_boxes) {
      if (distance < rounding_distance) return std::nullopt;
      normal = (candidate.start.first_point - candidate.start.second_point) / distance;
    }
    const Vec3 to_wall =
        m_.bodies.start_axes(body).transpose() * (first_is_wall ? normal : -normal);
    int axis = 0;
    if (to_wall.cwiseAbs().maxCoeff(&axis) < cosine_of_side) return std::nullopt;
    return Wall{m_.bodies.box(body), side(axis, to_wall[axis] > 0.0)};
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

bool is_between_walls(const SweptMemory& memory, const BodyPair& pair) {
  return !memory.between_walls.empty() &&
         std::ranges::find(memory.between_walls, pair) != memory.between_walls.end();
}

}  // namespace pneuma::sim

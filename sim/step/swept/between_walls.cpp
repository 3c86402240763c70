#include "sim/step/swept/between_walls.h"

#include <algorithm>

#include "sim/step/swept/wall_sides.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// Cosine of the angle up to which a wall is beside a side of the box.
constexpr double cosine_of_side = 0.9;
/// Of the distance wanted: what such a box keeps, twice what features keep on their ways
/// (SweptSearch::meets); and what it keeps less than the room in each gap.
constexpr double kept_of_wanted = 0.1, least_play = 0.02;
/// m/s^2, of the mass of a box: so much presses each of its contacts with walls that squeeze it. By
/// the usual friction that holds some eighty times its weight.
constexpr double squeeze_of_mass = 200.0;

bool is_one_of(std::span<const std::uint8_t> axes, const std::optional<BoxSide>& side) {
  return side && (axes[at(side->box)] >> side->axis & 1) != 0;
}

}  // namespace

int box_beside_wall(const World& world, const SweptMemory& memory, const BodyPair& bodies) {
  const auto is_wall = [&](int body) { return body == swept_ground || is_kinematic(world, body); };
  const auto [first, second] = bodies;
  if (is_wall(first) == is_wall(second)) return -1;
  const int body = is_wall(first) ? second : first;
  return memory.bodies.is_box(body) ? body : -1;
}

bool are_free_boxes(const World& world, const SweptMemory& memory, const BodyPair& bodies) {
  const auto is_free = [&](int body) {
    return body != swept_ground && memory.bodies.is_box(body) && !is_kinematic(world, body);
  };
  return is_free(bodies.first) && is_free(bodies.second);
}

std::optional<BoxSide> side_of_wall(const SweptMemory& memory, const BodyPair& bodies, int box,
                                    const Vec3& normal) {
  const Vec3 to_wall = box == bodies.first ? Vec3(-normal) : normal;
  const Vec3 along = memory.bodies.start_axes(box).transpose() * to_wall;
  int axis = 0;
  if (along.cwiseAbs().maxCoeff(&axis) < cosine_of_side) return std::nullopt;
  return BoxSide{memory.bodies.box(box), axis, along[axis] > 0.0};
}

WallVelocity velocity_of_wall(const World& world, const SweptMemory& memory, int body,
                              const Vec3& point) {
  const SweptBodies& bodies = memory.bodies;
  if (body == swept_ground || !bodies.is_box(body) || !bodies.pushes(body)) return {};
  const RigidBox& wall = world.rigid[at(bodies.box(body))];
  return {wall.velocity + wall.angular_velocity.cross(point - wall.position),
          wall.angular_velocity};
}

double room_between(const WallBeside& below, const WallBeside& above) {
  return below.distance + above.distance;
}

int free_box(const World& world, const SweptMemory& memory, const BodyPair& bodies) {
  return are_free_boxes(world, memory, bodies) ? bodies.first
                                               : box_beside_wall(world, memory, bodies);
}

const std::pair<WallBeside, WallBeside>* walls_along(const World& world, const SweptMemory& memory,
                                                     std::span<const std::uint8_t> axes,
                                                     const BodyPair& bodies, const Vec3& normal) {
  const int box = free_box(world, memory, bodies);
  if (box < 0) return nullptr;
  const auto side = side_of_wall(memory, bodies, box, normal);
  if (!is_one_of(axes, side)) return nullptr;
  if (are_free_boxes(world, memory, bodies) &&
      !is_one_of(axes, side_of_wall(memory, bodies, bodies.second, normal)))
    return nullptr;
  return &memory.walls_beside[at(side->box)].along[at(side->axis)];
}

bool may_be_between_walls(const SweptMemory& memory, const BodyPair& bodies) {
  const auto is_between = [&](int body) {
    return body != swept_ground && memory.bodies.is_rigid(body) &&
           memory.between_walls[at(memory.bodies.box(body))] != 0;
  };
  return bodies.second != swept_ground && (is_between(bodies.first) || is_between(bodies.second));
}

std::optional<double> kept_between_walls(const World& world, const SweptMemory& memory,
                                         const BodyPair& bodies, const Vec3& normal,
                                         double wanted) {
  if (!may_be_between_walls(memory, bodies)) return std::nullopt;
  const auto* walls = walls_along(world, memory, memory.between_walls, bodies, normal);
  if (!walls) return std::nullopt;
  const double most = kept_of_wanted * wanted, play = least_play * wanted;
  if (!memory.bodies.is_box(bodies.first) || !memory.bodies.is_box(bodies.second)) {
    return most;  // what passes through a model stops the run
  }
  const auto& [below, above] = *walls;
  const double share = room_between(below, above) / (below.gaps + above.gaps);
  const double kept = std::min(most, share - std::max(0.5 * share, play));
  // Between walls that come together as it sinks a box would go on for ever.
  return is_squeezed(world, memory, bodies, normal) ? kept : std::max(kept, -play);
}

int squeezed_box(const World& world, const SweptMemory& memory, const BodyPair& bodies) {
  if (memory.squeezed.empty()) return -1;
  const int box = free_box(world, memory, bodies);
  return box >= 0 && memory.squeezed[at(memory.bodies.box(box))] != 0 ? box : -1;
}

bool is_squeezed(const World& world, const SweptMemory& memory, const BodyPair& bodies,
                 const Vec3& normal) {
  return squeezed_box(world, memory, bodies) >= 0 &&
         walls_along(world, memory, memory.squeezed, bodies, normal);
}

double missing_room(const World& world, const SweptMemory& memory, const SweptContact& contact) {
  const BodyPair bodies = pair_of(contact);
  if (squeezed_box(world, memory, bodies) < 0) return 0.0;
  const auto* walls = walls_along(world, memory, memory.squeezed, bodies, contact.normal);
  return walls ? -room_between(walls->first, walls->second) : 0.0;
}

void squeeze_between_walls(const World& world, const SweptMemory& memory, double step,
                           SweptContact& contact, SweptImpulse& impulse) {
  const BodyPair bodies = pair_of(contact);
  if (squeezed_box(world, memory, bodies) < 0) return;
  const auto* walls = walls_along(world, memory, memory.squeezed, bodies, contact.normal);
  if (!walls) return;
  const auto& [below, above] = *walls;
  const int body = free_box(world, memory, bodies);
  const RigidBox& box = world.rigid[at(memory.bodies.box(body))];
  const double pressing = step * squeeze_of_mass * (below.mass + box.mass + above.mass);
  contact.is_gripped = walls_along(world, memory, memory.held, bodies, contact.normal);
  if (!contact.is_gripped) return impulse.squeeze(pressing);
  impulse.press(pressing);
  const BoxSide side = *side_of_wall(memory, bodies, body, contact.normal);
  const Vec3 apart = velocity_of_wall(world, memory, above.body, box.position).linear -
                     velocity_of_wall(world, memory, below.body, box.position).linear;
  contact.gap_rate =
      memory.bodies.start_axes(body).col(side.axis).dot(apart) / (below.gaps + above.gaps);
}

}  // namespace pneuma::sim

#include "sim/response/fall_asleep.h"

#include <algorithm>
#include <cmath>

#include "sim/inspect/inspect.h"
#include "sim/joints/body_springs.h"
#include "sim/joints/gas_flow.h"
#include "sim/soft/pins.h"

namespace pneuma::sim {
namespace {

/// s, for which nothing may be faster: a body that comes to a halt and turns round does not sleep.
constexpr double quiet_time = 0.5;
/// s, of soft bodies, which may move in it as far as in the other: in half a second a ball that
/// turns round on a slope of a degree would come back to where it was.
constexpr double quiet_time_of_soft = 1.0;

/// m/s^2. Where gravity is weaker, what it speeds up without end would be quiet for long too:
/// speeds of rest are less in proportion. Without gravity nothing rests but what stands still.
constexpr double weak_gravity = 5.0;

/// Of what a fall gains in a step: so fast do contacts shake what they hold.
constexpr double shaken = 2.0;

double sleep_speed(const Settings& settings) {
  return std::min(1.0, settings.gravity.norm() / weak_gravity) * settings.sleep_speed;
}

int quiet_steps(const World& world, int body) {
  const double seconds = body < soft_count(world) ? quiet_time_of_soft : quiet_time;
  return static_cast<int>(std::ceil(seconds * world.settings.steps_per_second));
}

/// Handles may move whenever their keys say so, gas may come or go, and what is at the other end of
/// a spring may move.
bool may_sleep(const World& world, int body) {
  if (is_kinematic(world, body)) return false;
  if (body >= soft_count(world)) return true;
  const SoftBody& soft = world.soft[at(body)];
  if (soft.pins && soft.pins->are_moved) return false;
  return !has_gas_flow(world, body) && !has_springs(world, body);
}

/// Whether the vertices are where they were, give or take `reach` (m): contacts shake what they
/// hold, so that the way of a single step would not tell.
bool stays(const SoftBody& body, const Vec3* places, double reach) {
  for (int v = 0; v < body.positions.size(); ++v) {
    if ((body.positions[v] - places[v]).squaredNorm() > reach * reach) return false;
  }
  return true;
}

/// Whether it moves in a step no further (m) on average than what contacts shake: it does not ring.
/// Velocities would not tell: those of a vertex that is pressed hold, at the end of a step, what
/// its forces did since the impulses of its start.
bool does_not_ring(const SoftBody& body, const VertexArray& before, double than) {
  const double squares = (body.positions.rows() - before.rows()).squaredNorm();
  return squares <= than * than * body.positions.size();
}

/// Whether no point of the box has moved further, m.
bool has_moved_less(const RigidBox& box, const RigidState& before, double than) {
  const double angle = box.orientation.angularDistance(before.orientation);
  return (box.position - before.position).norm() + angle * 0.5 * box.size.norm() <= than;
}

/// Returns its energy of motion, J.
double halt(World& world, int body) {
  const Vec3& gravity = world.settings.gravity;
  if (body < soft_count(world)) {
    SoftBody& soft = world.soft[at(body)];
    const double before = energy(soft, gravity).kinetic;
    soft.velocities.rows().setZero();
    return before;
  }
  RigidBox& box = world.rigid[at(body - soft_count(world))];
  const double before = energy(box, gravity).kinetic;
  box.velocity.setZero();
  box.angular_velocity.setZero();
  return before;
}

}  // namespace

double length_of_rest(const World& world, int body) {
  const int box = body - soft_count(world);
  const Vec3 size = box >= 0 ? world.rigid[at(box)].size
                             : bounds(world.soft[at(body)].mesh->rest_positions).size();
  return std::min(1.0, size.maxCoeff());
}

FallAsleep::FallAsleep(const World& world)
    : islands_(at(body_count(world))),
      never_sleeps_(islands_.size()),
      is_touched_(islands_.size()),
      stays_awake_(islands_.size()) {
  int vertices = 0;
  for (const SoftBody& body : world.soft) {
    first_vertices_.push_back(vertices);
    vertices += body.positions.size();
  }
  for (int i = 0; i < body_count(world); ++i) {
    sizes_.push_back(length_of_rest(world, i));
    never_sleeps_[at(i)] = may_sleep(world, i) ? 0 : 1;
  }
}

void FallAsleep::note_places(World& world, int soft) const {
  const VertexArray& positions = world.soft[at(soft)].positions;
  Vec3* places = world.quiet_places.data() + first_vertices_[at(soft)];
  for (int v = 0; v < positions.size(); ++v) places[v] = positions[v];
}

bool FallAsleep::is_quiet(const World& world, const MotionStart& start, int body) const {
  const Settings& settings = world.settings;
  const double speed = sleep_speed(settings) * sizes_[at(body)], step = time_step(settings);
  const int box = body - soft_count(world);
  if (box >= 0) return has_moved_less(world.rigid[at(box)], start.rigid[at(box)], step * speed);
  const SoftBody& soft = world.soft[at(body)];
  const double fastest = std::max(speed, shaken * step * settings.gravity.norm());
  return stays(soft, world.quiet_places.data() + first_vertices_[at(body)], quiet_time * speed) &&
         does_not_ring(soft, start.soft[at(body)].positions, step * fastest);
}

bool FallAsleep::count_quiet_steps(World& world, const MotionStart& start) {
  if (world.settings.sleep_speed == 0.0) return false;
  world.rest.resize(islands_.size());
  world.quiet_places.resize(at(soft_vertex_count(world)), Vec3::Zero());
  bool any = false;
  for (int i = 0; i < body_count(world); ++i) {
    BodyRest& rest = world.rest[at(i)];
    if (rest.group >= 0 || never_sleeps_[at(i)] != 0) continue;
    const bool rests = is_quiet(world, start, i);
    if (!rests && i < soft_count(world)) note_places(world, i);
    const int enough = quiet_steps(world, i);
    rest.quiet_steps = rests ? std::min(rest.quiet_steps + 1, enough) : 0;
    any = any || rest.quiet_steps == enough;
  }
  return any;
}

/// Nothing reaches through what stands still or is moved.
void FallAsleep::find_islands(const World& world, std::span<const BodyPair> pairs) {
  islands_.reset();
  for (const BodyPair& pair : pairs) {
    if (pair.second < 0 || is_kinematic(world, pair.first) || is_kinematic(world, pair.second)) {
      continue;
    }
    islands_.unite(pair.first, pair.second);
  }
}

void FallAsleep::find_who_stays_awake(const World& world, std::span<const Contact> contacts) {
  std::ranges::fill(is_touched_, std::uint8_t{0});
  std::ranges::fill(stays_awake_, std::uint8_t{0});
  const auto touch = [&](const ContactSide& side) {
    if (side.kind == SideKind::ground) return;
    const int body = side.kind == SideKind::soft ? side.body : soft_count(world) + side.body;
    is_touched_[at(islands_.find(body))] = 1;
  };
  for (const Contact& contact : contacts) {
    touch(contact.first);
    touch(contact.second);
  }
  for (int i = 0; i < body_count(world); ++i) {
    if (world.rest[at(i)].quiet_steps < quiet_steps(world, i))
      stays_awake_[at(islands_.find(i))] = 1;
  }
}

double FallAsleep::put_to_sleep(World& world, std::span<const BodyPair> pairs,
                                std::span<const Contact> contacts) {
  find_islands(world, pairs);
  find_who_stays_awake(world, contacts);
  double energy = 0.0;
  for (int i = 0; i < body_count(world); ++i) {
    const int first = islands_.find(i);
    if (is_asleep(world, i) || stays_awake_[at(first)] != 0 || is_touched_[at(first)] == 0) {
      continue;
    }
    world.rest[at(i)].group = first;
    energy += halt(world, i);
  }
  return energy;
}

void wake_moving(World& world) {
  if (world.rest.empty()) return;
  for (int i = 0; i < body_count(world); ++i) {
    if (is_asleep(world, i) && moves(world, i)) wake(world, i);
  }
}

bool is_at_rest(const World& world) {
  if (world.rest.empty()) return false;
  for (int i = 0; i < body_count(world); ++i) {
    if (!is_fixed(world, i)) return false;
  }
  for (int i = 0; i < body_count(world); ++i) {
    if (moves(world, i)) return false;
  }
  return true;
}

}  // namespace pneuma::sim

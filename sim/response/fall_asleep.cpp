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

/// m/s^2. Where gravity is weaker, what it speeds up without end would be quiet for long too:
/// speeds of rest are less in proportion.
constexpr double weak_gravity = 5.0;

double sleep_speed(const Settings& settings) {
  const double gravity = settings.gravity.norm();
  const double part = gravity > 0.0 ? std::min(1.0, gravity / weak_gravity) : 1.0;
  return part * settings.sleep_speed;
}

int quiet_steps(const Settings& settings) {
  return static_cast<int>(std::ceil(quiet_time * settings.steps_per_second));
}

/// Handles may move whenever their keys say so, gas may come or go, and what is at the other end of
/// a spring may move. A soft body that only the ground can touch needs no stage that would look.
bool may_sleep(const World& world, int body) {
  if (is_kinematic(world, body)) return false;
  if (body >= soft_count(world)) return true;
  if (body_count(world) == 1) return false;
  const SoftBody& soft = world.soft[at(body)];
  if (soft.pins && soft.pins->are_moved) return false;
  return !has_gas_flow(world, body) && !has_springs(world, body);
}

/// Vertices that lie apart, where their numbers say.
BodyRest::Places places_now(const SoftBody& body) {
  BodyRest::Places places;
  const auto count = static_cast<int>(places.cols());
  for (int i = 0; i < count; ++i) {
    places.col(i) = Vec3(body.positions[i * body.positions.size() / count]);
  }
  return places;
}

/// Whether the vertices are where they were, give or take `least` (m). A body that contacts shake
/// rests if it stays where it is: neither velocities nor the way of a single step would tell.
bool stays(const SoftBody& body, const BodyRest& rest, double least) {
  const BodyRest::Places moved = places_now(body) - rest.places;
  return moved.colwise().squaredNorm().maxCoeff() <= least * least;
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
  for (int i = 0; i < body_count(world); ++i) {
    sizes_.push_back(length_of_rest(world, i));
    never_sleeps_[at(i)] = may_sleep(world, i) ? 0 : 1;
  }
}

bool FallAsleep::count_quiet_steps(World& world, const MotionStart& start) {
  if (world.settings.sleep_speed == 0.0) return false;
  world.rest.resize(islands_.size());
  const int enough = quiet_steps(world.settings);
  const double speed = sleep_speed(world.settings), step = time_step(world.settings);
  bool any = false;
  for (int i = 0; i < body_count(world); ++i) {
    BodyRest& rest = world.rest[at(i)];
    if (rest.group >= 0 || never_sleeps_[at(i)] != 0) continue;
    const int box = i - soft_count(world);
    const double way = speed * sizes_[at(i)];
    const bool is_quiet =
        box < 0 ? stays(world.soft[at(i)], rest, quiet_time * way)
                : has_moved_less(world.rigid[at(box)], start.rigid[at(box)], step * way);
    if (box < 0 && !is_quiet) rest.places = places_now(world.soft[at(i)]);
    rest.quiet_steps = is_quiet ? std::min(rest.quiet_steps + 1, enough) : 0;
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
  const int enough = quiet_steps(world.settings);
  for (int i = 0; i < body_count(world); ++i) {
    if (world.rest[at(i)].quiet_steps < enough) stays_awake_[at(islands_.find(i))] = 1;
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

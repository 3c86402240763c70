#include "sim/step/swept/excess_work.h"

#include <algorithm>
#include <cmath>

#include "sim/inspect/state_energy.h"
#include "sim/joints/body_springs.h"
#include "sim/response/group_motion.h"
#include "sim/response/vibration.h"

namespace pneuma::sim {
namespace {

/// Of what was lost before, per step. The energy of what is loaded heavily goes up and down over
/// some steps.
constexpr double kept_of_loss = 0.9;
/// Of vibrations, per step, that is taken for work that has not made energy grow.
constexpr double fraction_of_vibration = 0.02;
/// Of what a fall gains in a step: slower vibrations, and motions of bodies against each other,
/// count as rest. So a load on soft bodies that is out of balance by less than a 20th of its weight
/// may stay where it is.
constexpr double quiet_vibration = 0.2, quiet_speed = 0.05;

/// What bears an island without being moved by impulses: the ground and bodies that nothing moves,
/// or bodies that keep their velocities, and pins.
enum class Holder { none, at_rest, moved };

/// J, that an island gives up.
struct Due {
  double must = 0.0;  // as its energy has grown
  double may = 0.0;   // besides, as its contacts have done work
  double fall = 0.0;  // of one step from rest
  Holder holder = Holder::none;

  double all() const { return must + may; }
  /// J, that counts as rest.
  double of_rest() const { return std::min(may, quiet_speed * quiet_speed * fall); }
  double of_vibration(double motion) const {
    const double quiet = quiet_vibration * quiet_vibration * fall;
    const double most = std::max(fraction_of_vibration * motion, quiet);
    return std::min(motion, must + std::min(may, most));
  }
  void pay(double taken) {
    const double of_must = std::min(must, taken);
    must -= of_must;
    may = std::max(0.0, may - (taken - of_must));
  }
  void forgive(double energy) {
    const double of_may = std::min(may, energy);
    may -= of_may;
    must = std::max(0.0, must - (energy - of_may));
  }
};

/// Of an island, by their place in the world.
template <class Visit>
void for_each_soft_body(const World& world, SweptMemory& memory, int island, const Visit& visit) {
  for (int i = 0; i < static_cast<int>(world.soft.size()); ++i) {
    if (memory.solver.island_of(i) == island) visit(at(i));
  }
}

/// Returns what was taken, J.
double slow_vibrations(World& world, SweptMemory& memory, int island, const Due& due) {
  double there_is = 0.0;
  for_each_soft_body(world, memory, island,
                     [&](std::size_t i) { there_is += energy_of_vibration(world.soft[i]); });
  const double asked_for = due.of_vibration(there_is);
  if (!(asked_for > 0.0)) return 0.0;
  const double factor = std::sqrt(1.0 - asked_for / there_is);
  double taken = 0.0;
  for_each_soft_body(world, memory, island, [&](std::size_t i) {
    const bool on_ground = due.holder == Holder::at_rest && memory.on_ground[i].is_held;
    taken += slow_vibration(world.soft[i], factor, on_ground);
  });
  return taken;
}

/// The bodies of an island, in `memory.members`.
GroupMotion motion_of_island(World& world, SweptMemory& memory, int island) {
  memory.members.clear();
  for (int i = 0; i < memory.bodies.count(); ++i) {
    if (memory.solver.island_of(i) == island) memory.members.push_back(i);
  }
  return {world, memory.members};
}

/// Of the soft bodies of an island.
template <class Is>
bool any_soft_body(const World& world, SweptMemory& memory, int island, const Is& is) {
  for (int i = 0; i < static_cast<int>(world.soft.size()); ++i) {
    if (is(at(i)) && memory.solver.island_of(i) == island) return true;
  }
  return false;
}

Holder holder_of(const World& world, SweptMemory& memory, int island) {
  Holder holder = Holder::none;
  for (const SweptImpulse* impulse : memory.solver.impulses_of(island)) {
    if (impulse->first().moves() && impulse->second().moves()) continue;
    const std::size_t i = memory.contact_of(impulse);
    if ((memory.given_at_start[i] + impulse->given()).isZero(0.0)) continue;  // it bears nothing
    const SweptContact& contact = memory.contacts[i];
    const int body = impulse->first().moves() ? contact.second.body : contact.first.body;
    if (body != swept_ground && memory.bodies.moves(world, body)) return Holder::moved;
    holder = Holder::at_rest;
  }
  const auto any = [&](const auto& is) { return any_soft_body(world, memory, island, is); };
  if (any([&](std::size_t i) { return world.soft[i].pins != nullptr; })) return Holder::moved;
  return any([&](std::size_t i) { return memory.on_ground[i].is_held; }) ? Holder::at_rest : holder;
}

/// By springs to other bodies.
bool is_pulled(const World& world, SweptMemory& memory, int island) {
  return any_soft_body(world, memory, island,
                       [&](std::size_t i) { return has_springs(world, static_cast<int>(i)); });
}

/// J, of one step from rest.
double energy_of_fall(const Settings& settings, double mass) {
  return 0.5 * mass * (time_step(settings) * settings.gravity).squaredNorm();
}

double spring_energy_of_island(World& world, SweptMemory& memory, int island) {
  double sum = 0.0;
  for_each_soft_body(world, memory, island, [&](std::size_t i) {
    sum += energy(world.soft[i], world.settings.gravity).spring;
  });
  return sum;
}

/// Of islands with soft bodies: by how much their energy has grown in the step, and what they may
/// give back of what they lost before.
class EnergyAccount {
 public:
  EnergyAccount(World& world, const MotionStart& start, SweptMemory& memory)
      : world_(world), start_(start), m_(memory) {
    std::swap(world.lost_energy, memory.lost_energy);
    world.lost_energy.assign(world.soft.size(), 0.0);
    memory.lost_energy.resize(world.soft.size());
  }

  /// Of boxes alone, which nothing damps, all that contacts added.
  Due due(int island) {
    const double work = m_.work_of_islands[at(island)];
    const Holder holder = holder_of(world_, m_, island);
    int count = 0;
    for_each_soft_body(world_, m_, island, [&](std::size_t) { ++count; });
    if (count == 0 || holder == Holder::none) return {.must = work, .holder = holder};
    double growth = 0.0, before = 0.0;
    for_each_soft_body(world_, m_, island, [&](std::size_t i) {
      growth += growth_of(world_.soft[i], start_.soft[i]);
      before += m_.lost_energy[i];
    });
    for (std::size_t i = 0; i < world_.rigid.size(); ++i) {
      const int body = m_.bodies.of_box(static_cast<int>(i));
      if (m_.solver.island_of(body) != island) continue;
      growth += growth_of(world_.rigid[i], start_.rigid[i]);
    }
    const double must = std::max(0.0, std::min(work, growth - before)), kept = growth - must;
    const double lost =
        kept_of_loss * std::max(0.0, before - std::max(0.0, kept)) + std::max(0.0, -kept);
    for_each_soft_body(world_, m_, island,
                       [&](std::size_t i) { world_.lost_energy[i] = lost / count; });
    const double mass = motion_of_island(world_, m_, island).mass();
    return {.must = must,
            .may = work - must,
            .fall = energy_of_fall(world_.settings, mass),
            .holder = holder};
  }

 private:
  template <class Body, class State>
  double growth_of(const Body& body, const State& start) const {
    const Vec3& gravity = world_.settings.gravity;
    return energy(body, gravity).total() - energy(body, start, gravity).total();
  }

  World& world_;
  const MotionStart& start_;
  SweptMemory& m_;
};

/// Of an island's energy of motion and springs, what rounding may leave in a step.
constexpr double max_added_work = 1e-9;

/// N s, of the impulses of an island at both ends of the step, without their directions.
double size_of_impulses(const SweptMemory& memory, int island) {
  double sum = 0.0;
  for (const SweptImpulse* impulse : memory.solver.impulses_of(island)) {
    sum += memory.given_at_start[memory.contact_of(impulse)].norm() + impulse->given().norm();
  }
  return sum;
}

/// Takes energy (J, > 0) from the motion of an island's bodies that is not that of one rigid body
/// with their momentum and angular momentum: these stay as they are. Where the ground, or another
/// body at rest, holds an island of boxes it takes from all motion, whose momentum the holder gets;
/// not of one with soft bodies: what starts to roll would stay where it is. Loads
/// press soft bodies at the start of each step, whose damping takes that until its end, so that
/// contacts with these do some work at rest: as much as falls by a step is let be. All velocities
/// against each other shrink by the same factor, so that at contacts what parts still parts.
/// Nothing is asked for if pins, or bodies that keep their velocities, hold the island. Of one that
/// nothing holds or pulls, whose energy its loads cannot change, none may be left but what rounding
/// leaves, and the `tolerance` (m/s) to which velocities are solved for.
Excess take_from_relative_motion(World& world, SweptMemory& memory, int island, Due due,
                                 double tolerance) {
  const Holder holder = due.holder;
  if (holder == Holder::moved) return {};
  GroupMotion motion = motion_of_island(world, memory, island);
  const bool is_held = holder != Holder::none, is_soft = motion.has_soft_bodies();
  if (is_held && is_soft) due.forgive(energy_of_fall(world.settings, motion.mass()));
  if (!is_held || is_soft) motion.leave_out_common();
  const double taken = motion.take(due.must + due.of_rest()), left = due.must - taken;
  if (holder != Holder::none || !(left > 0.0) || is_pulled(world, memory, island))
    return {.taken = taken};
  // What is left at each contact adds up from body to body.
  const double bodies = static_cast<double>(memory.members.size());
  const double of_solution = 0.5 * motion.mass() * bodies * tolerance * tolerance +
                             tolerance_of_boxes * tolerance * size_of_impulses(memory, island);
  const double of_motion = taken + GroupMotion(world, memory.members).energy();  // also in common
  const double all = of_motion + spring_energy_of_island(world, memory, island);
  const double allowed = max_added_work * all + of_solution;
  return {.taken = taken, .left = left > allowed ? left : 0.0};
}

}  // namespace

Excess take_back_excess_work(World& world, const MotionStart& start, SweptMemory& memory,
                             double tolerance) {
  Excess all;
  if (is_implicit(world.settings.integrator)) return all;
  EnergyAccount account(world, start, memory);
  for (std::size_t i = 0; i < memory.work_of_islands.size(); ++i) {
    const int island = static_cast<int>(i);
    Due due = account.due(island);
    if (!(due.all() > 0.0)) continue;
    const double of_vibrations = slow_vibrations(world, memory, island, due);
    all.taken += of_vibrations;
    due.pay(of_vibrations);
    if (!(due.all() > 0.0)) continue;
    const Excess of_island = take_from_relative_motion(world, memory, island, due, tolerance);
    all.taken += of_island.taken;
    if (of_island.left > all.left) {
      all.left = of_island.left;
      all.island = island;
    }
  }
  return all;
}

}  // namespace pneuma::sim

#include "sim/step/returned_energy.h"

#include <algorithm>
#include <cmath>

#include "sim/inspect/inspect.h"
#include "sim/response/group_motion.h"
#include "sim/response/vibration.h"

namespace pneuma::sim {
namespace {

std::size_t contact_of(const SweptMemory& memory, const SweptImpulse* impulse) {
  return static_cast<std::size_t>(impulse - memory.impulses.data());
}

bool is_hit(const SweptContact& contact) { return contact.returns_energy && contact.is_near; }

/// The contacts of an island, as one impact.
class LoneImpact {
 public:
  LoneImpact(SweptMemory& memory, int island)
      : m_(memory), impulses_(memory.solver.impulses_of(island)) {}

  bool is_of_two_boxes() const {
    const SweptContact& first = contact(impulses_.front());
    const int one = first.first.body, other = first.second.body;
    if (!m_.bodies.is_box(one) || !(other == swept_ground || m_.bodies.is_box(other))) return false;
    return std::ranges::all_of(impulses_, [&](const SweptImpulse* impulse) {
      return contact(impulse).first.body == one && contact(impulse).second.body == other;
    });
  }
  bool bounces_and_rubs() const {
    return std::ranges::any_of(impulses_, [&](const SweptImpulse* impulse) {
      return is_hit(contact(impulse)) && impulse->has_friction();
    });
  }

  void follow(double tolerance) {
    double restitution = 0.0;  // the same at all points of two bodies
    m_.impact_points.clear();
    for (SweptImpulse* impulse : impulses_) {
      const SweptContact& at_end = contact(impulse);
      ImpactPoint point{.impulse = impulse,
                        .velocity = m_.end_velocities[contact_of(m_, impulse)],
                        .parting = at_end.parting};
      point.speed = at_end.normal.dot(point.velocity);
      if (is_hit(at_end)) {
        point.speed += at_end.drift;
        point.approach = at_end.approach;
        restitution = at_end.restitution;
      }
      m_.impact_points.push_back(point);
    }
    m_.impact_path.follow(m_.impact_points, restitution, tolerance);
  }

 private:
  const SweptContact& contact(const SweptImpulse* impulse) const {
    return m_.contacts[contact_of(m_, impulse)];
  }

  SweptMemory& m_;
  std::span<SweptImpulse* const> impulses_;
};

class ReturnedEnergy {
 public:
  ReturnedEnergy(SweptMemory& memory, double tolerance)
      : m_(memory), r_(memory.returned_energy), tolerance_(tolerance) {}

  void limit() {
    m_.work_of_islands.clear();
    if (m_.contacts.empty()) return;
    find_islands_that_return();
    m_.work_of_islands.assign(r_.returns.size(), 0.0);
    for (std::size_t i = 0; i < m_.contacts.size(); ++i) m_.work_of_islands[island(i)] += work(i);
    add_work_of_start();
    r_.given.resize(m_.contacts.size());
    for (std::size_t i = 0; i < r_.returns.size(); ++i) {
      double& of_island = m_.work_of_islands[i];
      if (r_.returns[i] != 0 && of_island > 0.0) limit(static_cast<int>(i), of_island);
    }
  }

 private:
  std::size_t island(std::size_t contact) const {
    return at(m_.solver.island_of(m_.contacts[contact], m_.impulses[contact]));
  }
  double work(std::size_t contact) const {
    return m_.impulses[contact].work(m_.end_velocities[contact]);
  }

  void find_islands_that_return() {
    r_.returns.assign(at(m_.solver.island_count()), 0);
    for (std::size_t i = 0; i < m_.contacts.size(); ++i) {
      if (m_.contacts[i].returns_energy) r_.returns[island(i)] = 1;
    }
  }

  /// What acted at the start is a contact at the end.
  void add_work_of_start() {
    for (std::size_t i = 0; i < m_.first_contacts.size(); ++i) {
      const int island = m_.solver.island_of(m_.first_contacts[i], m_.first_impulses[i]);
      if (island >= 0) m_.work_of_islands[at(island)] += m_.work_of_start[i];
    }
  }

  /// `work_of_island`: J, which is then that of the mixture.
  void limit(int island, double& work_of_island) {
    const auto impulses = m_.solver.impulses_of(island);
    const double with = work_of_island;
    double without = with;
    for (SweptImpulse* impulse : impulses) {
      const std::size_t i = contact_of(m_, impulse);
      const SweptContact& contact = m_.contacts[i];
      without -= work(i);
      r_.given[i] = impulse->given();
      const double parting = contact.returns_energy ? 0.0 : contact.parting;
      impulse->aim(parting - contact.normal.dot(m_.end_velocities[i]), m_.end_velocities[i]);
    }
    work_of_island = without;  // that of the start
    m_.solver.solve_island(island, tolerance_);
    for (const SweptImpulse* impulse : impulses) without += work(contact_of(m_, impulse));
    const double share = without < 0.0 ? without / (without - with) : 0.0;
    for (SweptImpulse* impulse : impulses) {
      const Vec3 mixed =
          share * r_.given[contact_of(m_, impulse)] + (1.0 - share) * impulse->given();
      impulse->replace_given(to_vec4d(mixed));
    }
    for (const SweptImpulse* impulse : impulses) work_of_island += work(contact_of(m_, impulse));
  }

  SweptMemory& m_;
  ReturnedEnergyMemory& r_;
  double tolerance_;  // m/s
};

template <class Visit>
void for_each_soft_body(World& world, SweptMemory& memory, int island, const Visit& visit) {
  for (int i = 0; i < static_cast<int>(world.soft.size()); ++i) {
    if (memory.solver.island_of(i) == island) visit(world.soft[at(i)]);
  }
}

/// Returns what was taken, J: no more than there is.
double slow_vibrations(World& world, SweptMemory& memory, int island, double excess) {
  double there_is = 0.0;
  for_each_soft_body(world, memory, island,
                     [&](const SoftBody& body) { there_is += energy_of_vibration(body); });
  const double taken = std::min(excess, there_is);
  if (!(taken > 0.0)) return 0.0;
  const double factor = std::sqrt(1.0 - taken / there_is);
  for_each_soft_body(world, memory, island, [&](SoftBody& body) { slow_vibration(body, factor); });
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

bool has_pins(const World& world, SweptMemory& memory, int island) {
  for (int i = 0; i < static_cast<int>(world.soft.size()); ++i) {
    if (world.soft[at(i)].pins && memory.solver.island_of(i) == island) return true;
  }
  return false;
}

/// What bears an island without being moved by impulses: the ground and bodies that nothing moves,
/// or bodies that keep their velocities, and pins.
enum class Holder { none, at_rest, moved };

Holder holder_of(const World& world, SweptMemory& memory, int island) {
  Holder holder = Holder::none;
  for (const SweptImpulse* impulse : memory.solver.impulses_of(island)) {
    if (impulse->first().moves() && impulse->second().moves()) continue;
    const std::size_t i = contact_of(memory, impulse);
    if ((memory.given_at_start[i] + impulse->given()).isZero(0.0)) continue;  // it bears nothing
    const SweptContact& contact = memory.contacts[i];
    const int body = impulse->first().moves() ? contact.second.body : contact.first.body;
    if (body != swept_ground && moves(world, body)) return Holder::moved;
    holder = Holder::at_rest;
  }
  return has_pins(world, memory, island) ? Holder::moved : holder;
}

/// J, of one step from rest.
double energy_of_fall(const Settings& settings, double mass) {
  return 0.5 * mass * (time_step(settings) * settings.gravity).squaredNorm();
}

double spring_energy_of_island(World& world, SweptMemory& memory, int island) {
  double sum = 0.0;
  for_each_soft_body(world, memory, island, [&](const SoftBody& body) {
    sum += energy(body, world.settings.gravity).spring;
  });
  return sum;
}

/// Of an island's energy of motion and springs, what rounding may leave in a step.
constexpr double max_added_work = 1e-9;

/// Takes energy (J, > 0) from the motion of an island's bodies that is not that of one rigid body
/// with their momentum and angular momentum: these stay as they are. Where the ground, or another
/// body at rest, holds the island it takes from all motion, whose momentum the holder gets. Loads
/// press soft bodies at the start of each step, whose damping takes that until its end, so that
/// contacts with these do some work at rest: as much as falls by a step is let be. All velocities
/// against each other shrink by the same factor, so that at contacts what parts still parts.
/// Nothing is asked for if pins, or bodies that keep their velocities, hold the island. Of one that
/// nothing holds, whose energy its loads cannot change, none may be left but what rounding leaves,
/// and the `tolerance` (m/s) to which velocities are solved for.
Excess take_from_relative_motion(World& world, SweptMemory& memory, int island, double energy,
                                 double tolerance) {
  const Holder holder = holder_of(world, memory, island);
  if (holder == Holder::moved) return {};
  GroupMotion motion = motion_of_island(world, memory, island);
  if (holder == Holder::none) {
    motion.leave_out_common();
  } else if (motion.has_soft_bodies()) {
    energy = std::max(0.0, energy - energy_of_fall(world.settings, motion.mass()));
  }
  const double taken = motion.take(energy), left = energy - taken;
  if (holder != Holder::none || !(left > 0.0)) return {.taken = taken};
  const double of_solution = 0.5 * motion.mass() * tolerance * tolerance;
  const double all = taken + motion.energy() + spring_energy_of_island(world, memory, island);
  return {.taken = taken, .left = left > max_added_work * all + of_solution ? left : 0.0};
}

}  // namespace

void follow_impacts(SweptMemory& memory, double tolerance) {
  if (std::ranges::none_of(memory.contacts, is_hit)) return;
  for (int island = 0; island < memory.solver.island_count(); ++island) {
    LoneImpact impact(memory, island);
    if (impact.is_of_two_boxes() && impact.bounces_and_rubs()) impact.follow(tolerance);
  }
}

void limit_returned_energy(SweptMemory& memory, double tolerance) {
  ReturnedEnergy(memory, tolerance).limit();
}

Excess take_back_excess_work(World& world, SweptMemory& memory, double tolerance) {
  Excess all;
  if (is_implicit(world.settings.integrator)) return all;
  for (std::size_t i = 0; i < memory.work_of_islands.size(); ++i) {
    const int island = static_cast<int>(i);
    const double work = memory.work_of_islands[i];
    if (!(work > 0.0)) continue;
    const double of_vibrations = slow_vibrations(world, memory, island, work);
    all.taken += of_vibrations;
    if (of_vibrations >= work) continue;
    const Excess of_island =
        take_from_relative_motion(world, memory, island, work - of_vibrations, tolerance);
    all.taken += of_island.taken;
    if (of_island.left > all.left) {
      all.left = of_island.left;
      all.island = island;
    }
  }
  return all;
}

}  // namespace pneuma::sim

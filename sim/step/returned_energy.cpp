#include "sim/step/returned_energy.h"

#include <algorithm>
#include <cmath>

#include "sim/response/vibration.h"

namespace pneuma::sim {
namespace {

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

  std::size_t contact_of(const SweptImpulse* impulse) const {
    return static_cast<std::size_t>(impulse - m_.impulses.data());
  }

  /// `work_of_island`: J, which is then that of the mixture.
  void limit(int island, double& work_of_island) {
    const auto impulses = m_.solver.impulses_of(island);
    const double with = work_of_island;
    double without = with;
    for (SweptImpulse* impulse : impulses) {
      const std::size_t i = contact_of(impulse);
      const SweptContact& contact = m_.contacts[i];
      without -= work(i);
      r_.given[i] = impulse->given();
      const double parting = contact.returns_energy ? 0.0 : contact.parting;
      impulse->aim(parting - contact.normal.dot(m_.end_velocities[i]), m_.end_velocities[i]);
    }
    work_of_island = without;  // that of the start
    m_.solver.solve_island(island, tolerance_);
    for (const SweptImpulse* impulse : impulses) without += work(contact_of(impulse));
    const double share = without < 0.0 ? without / (without - with) : 0.0;
    for (SweptImpulse* impulse : impulses) {
      const Vec3 mixed = share * r_.given[contact_of(impulse)] + (1.0 - share) * impulse->given();
      impulse->replace_given(to_vec4d(mixed));
    }
    for (const SweptImpulse* impulse : impulses) work_of_island += work(contact_of(impulse));
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

}  // namespace

void limit_returned_energy(SweptMemory& memory, double tolerance) {
  ReturnedEnergy(memory, tolerance).limit();
}

double take_back_excess_work(World& world, SweptMemory& memory) {
  double taken = 0.0;
  if (is_implicit(world.settings.integrator)) return taken;
  for (std::size_t i = 0; i < memory.work_of_islands.size(); ++i) {
    const double work = memory.work_of_islands[i];
    if (work > 0.0) taken += slow_vibrations(world, memory, static_cast<int>(i), work);
  }
  return taken;
}

}  // namespace pneuma::sim

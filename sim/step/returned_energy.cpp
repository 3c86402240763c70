#include "sim/step/returned_energy.h"

#include <algorithm>

namespace pneuma::sim {
namespace {

class ReturnedEnergy {
 public:
  ReturnedEnergy(SweptMemory& memory, double tolerance)
      : m_(memory), r_(memory.returned_energy), tolerance_(tolerance) {}

  void limit() {
    if (m_.contacts.empty() || !find_islands_that_return()) return;
    r_.work.assign(r_.returns.size(), 0.0);
    for (std::size_t i = 0; i < m_.contacts.size(); ++i) r_.work[island(i)] += work(i);
    add_work_of_start();
    r_.given.resize(m_.contacts.size());
    for (std::size_t i = 0; i < r_.work.size(); ++i) {
      if (r_.returns[i] != 0 && r_.work[i] > 0.0) limit(static_cast<int>(i), r_.work[i]);
    }
  }

 private:
  std::size_t island(std::size_t contact) const {
    return at(m_.solver.island_of(m_.contacts[contact].first.body));
  }
  double work(std::size_t contact) const {
    return m_.impulses[contact].work(m_.end_velocities[contact]);
  }

  bool find_islands_that_return() {
    r_.returns.assign(at(m_.solver.island_count()), 0);
    bool found = false;
    for (std::size_t i = 0; i < m_.contacts.size(); ++i) {
      if (!m_.contacts[i].returns_energy) continue;
      r_.returns[island(i)] = 1;
      found = true;
    }
    return found;
  }

  /// What acted at the start is a contact at the end.
  void add_work_of_start() {
    for (std::size_t i = 0; i < m_.first_contacts.size(); ++i) {
      const int of_first = m_.solver.island_of(m_.first_contacts[i].first.body);
      if (of_first >= 0) r_.work[at(of_first)] += m_.work_of_start[i];
    }
  }

  std::size_t contact_of(const SweptImpulse* impulse) const {
    return static_cast<std::size_t>(impulse - m_.impulses.data());
  }

  void limit(int island, double with) {
    const auto impulses = m_.solver.impulses_of(island);
    double without = with;
    for (SweptImpulse* impulse : impulses) {
      const std::size_t i = contact_of(impulse);
      const SweptContact& contact = m_.contacts[i];
      without -= work(i);
      r_.given[i] = impulse->given();
      const double parting = contact.returns_energy ? 0.0 : contact.parting;
      impulse->aim(parting - contact.normal.dot(m_.end_velocities[i]), m_.end_velocities[i]);
    }
    m_.solver.solve_island(island, tolerance_);
    for (const SweptImpulse* impulse : impulses) without += work(contact_of(impulse));
    const double share = without < 0.0 ? without / (without - with) : 0.0;
    for (SweptImpulse* impulse : impulses) {
      const Vec3 mixed = share * r_.given[contact_of(impulse)] + (1.0 - share) * impulse->given();
      impulse->replace_given(to_vec4d(mixed));
    }
  }

  SweptMemory& m_;
  ReturnedEnergyMemory& r_;
  double tolerance_;  // m/s
};

}  // namespace

void limit_returned_energy(SweptMemory& memory, double tolerance) {
  ReturnedEnergy(memory, tolerance).limit();
}

}  // namespace pneuma::sim

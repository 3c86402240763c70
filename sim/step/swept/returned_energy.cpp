#include "sim/step/swept/returned_energy.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {
namespace {

/// Of the impulses that were found: the multiple of them all that does least work, if it is less.
/// Small differences are what is left of any solution.
constexpr double least_share_of_found = 0.9;
/// Of the work of the start, which the impulses of the end may add again where they take back those
/// of the start.
constexpr double most_added_again = 2.0;

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
  /// That needs to be followed: it bounces and rubs, or stops what weight presses as well.
  bool has_a_path() const {
    return std::ranges::any_of(impulses_, [&](const SweptImpulse* impulse) {
      return contact(impulse).stops || (is_hit(contact(impulse)) && impulse->has_friction());
    });
  }

  void follow(double tolerance) {
    double restitution = 0.0;  // the same at all points of two bodies
    m_.impact_points.clear();
    for (SweptImpulse* impulse : impulses_) {
      const SweptContact& at_end = contact(impulse);
      ImpactPoint point{.impulse = impulse,
                        .velocity = m_.end_velocities[m_.contact_of(impulse)],
                        .parting = at_end.parting};
      point.speed = at_end.normal.dot(point.velocity);
      if (is_impact(at_end)) {
        point.speed += at_end.drift;
        point.approach = at_end.approach;
        restitution = std::max(restitution, at_end.restitution);
      }
      m_.impact_points.push_back(point);
    }
    m_.impact_path.follow(m_.impact_points, restitution, tolerance);
  }

 private:
  const SweptContact& contact(const SweptImpulse* impulse) const {
    return m_.contacts[m_.contact_of(impulse)];
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
    add_work_of_ground();
    r_.given.resize(m_.contacts.size());
    for (std::size_t i = 0; i < r_.returns.size(); ++i) {
      double& of_island = m_.work_of_islands[i];
      if (!(of_island > 0.0)) continue;
      const int island = static_cast<int>(i);
      if (r_.returns[i] != 0 && limit(island, of_island)) continue;
      shorten(island, of_island);
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

  /// On vertices that meet it by themselves.
  void add_work_of_ground() {
    for (std::size_t i = 0; i < m_.on_ground.size(); ++i) {
      if (!m_.on_ground[i].is_held) continue;
      const int island = m_.solver.island_of(static_cast<int>(i));
      if (island >= 0) m_.work_of_islands[at(island)] += m_.on_ground[i].work;
    }
  }

  /// m/s, at which the sides part if nothing is returned.
  static double without_return(const SweptContact& contact) {
    return contact.returns_energy ? 0.0 : contact.parting;
  }

  /// `work_of_island`: J, which is then that of the mixture. Returns false if nothing is returned.
  bool limit(int island, double& work_of_island) {
    const auto impulses = m_.solver.impulses_of(island);
    const double with = work_of_island;
    double without = with;
    for (SweptImpulse* impulse : impulses) {
      const std::size_t i = m_.contact_of(impulse);
      const SweptContact& contact = m_.contacts[i];
      without -= work(i);
      r_.given[i] = impulse->given();
      impulse->aim(without_return(contact) - contact.normal.dot(m_.end_velocities[i]),
                   m_.end_velocities[i]);
    }
    work_of_island = without;  // that of the start
    m_.solver.solve_island(island, tolerance_);
    for (const SweptImpulse* impulse : impulses) without += work(m_.contact_of(impulse));
    const double share = without < 0.0 ? without / (without - with) : 0.0;
    for (SweptImpulse* impulse : impulses) {
      const Vec3 mixed =
          share * r_.given[m_.contact_of(impulse)] + (1.0 - share) * impulse->given();
      impulse->replace_given(to_vec4d(mixed));
    }
    for (const SweptImpulse* impulse : impulses) work_of_island += work(m_.contact_of(impulse));
    return share > 0.0;
  }

  /// Against velocities less those that are aimed at, J v + 1/2 J dv, no multiple of a solution
  /// does less work than the solution itself.
  void shorten(int island, double& work_of_island) {
    const auto impulses = m_.solver.impulses_of(island);
    double before = 0.0, change = 0.0, of_end = 0.0;
    for (const SweptImpulse* impulse : impulses) {
      const std::size_t i = m_.contact_of(impulse);
      const SweptContact& contact = m_.contacts[i];
      const Vec3 wanted = without_return(contact) * contact.normal, given = impulse->given();
      before += given.dot(m_.end_velocities[i] - wanted);
      change += given.dot(impulse->change());
      of_end += work(i);
    }
    const double of_start = work_of_island - of_end;
    if (!(of_end > most_added_again * std::abs(of_start))) return;
    if (!(-before < least_share_of_found * change)) return;
    const double share = std::max(0.0, -before / change);
    for (const SweptImpulse* impulse : impulses) {
      r_.given[m_.contact_of(impulse)] = share * impulse->given();
    }
    for (SweptImpulse* impulse : impulses) {
      impulse->replace_given(to_vec4d(r_.given[m_.contact_of(impulse)]));
    }
    work_of_island = of_start;
    for (const SweptImpulse* impulse : impulses) work_of_island += work(m_.contact_of(impulse));
  }

  SweptMemory& m_;
  ReturnedEnergyMemory& r_;
  double tolerance_;  // m/s
};

}  // namespace

void follow_impacts(SweptMemory& memory, double tolerance) {
  if (std::ranges::none_of(memory.contacts, is_impact)) return;
  for (int island = 0; island < memory.solver.island_count(); ++island) {
    LoneImpact impact(memory, island);
    if (impact.is_of_two_boxes() && impact.has_a_path()) impact.follow(tolerance);
  }
}

void limit_returned_energy(SweptMemory& memory, double tolerance) {
  ReturnedEnergy(memory, tolerance).limit();
}

}  // namespace pneuma::sim

#include "sim/step/alone_on_ground.h"

#include <algorithm>

#include "sim/collision/find_body_contacts.h"
#include "sim/inspect/inspect.h"
#include "sim/response/ground_contact.h"

namespace pneuma::sim {
namespace {

class AloneOnGround {
 public:
  AloneOnGround(World& world, const SweptSearch& search, StepWorkspace& workspace)
      : world_(world), search_(search), w_(workspace), m_(*workspace.swept) {}

  bool has_any(int soft) const {
    return !is_fixed(world_, soft) &&
           (m_.bodies.is_lone(soft) || m_.on_ground[at(soft)].meets_alone);
  }

  void resolve(int soft) {
    const SoftState& start = w_.motion_start.soft[at(soft)];
    if (m_.bodies.is_lone(soft)) {
      meet_ground_alone(world_, soft, start, w_.contacts, m_.before_ground);
    } else {
      resolve_beside_others(soft, start);
    }
  }

 private:
  /// Nothing that is not a candidate can touch these vertices within the allowance.
  void resolve_beside_others(int soft, const SoftState& start) {
    SoftBody& body = world_.soft[at(soft)];
    OnGround& on_ground = m_.on_ground[at(soft)];
    const std::span<Contact> alone = find_alone(soft);
    resolve_on_ground(world_, soft, start, alone, m_.before_ground);
    for (const Contact& contact : alone) {
      const int v = contact.first.feature.index;
      const Vec3 wanted = body.positions[v];
      body.positions[v] = m_.bodies.within_allowance(soft, v, contact.point, wanted);
      const double given = contact.impulse.squaredNorm() / body.material.vertex_mass;
      on_ground.work += contact.impulse.dot(body.velocities[v]) - 0.5 * given;
      on_ground.is_held = true;
    }
  }

  std::span<Contact> find_alone(int soft) {
    const std::size_t first = w_.contacts.size();
    find_soft_ground(world_, soft, w_.contacts);
    const auto begin = w_.contacts.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = std::remove_if(begin, w_.contacts.end(), [&](const Contact& contact) {
      return !search_.is_alone(soft, contact.first.feature.index);
    });
    w_.contacts.erase(end, w_.contacts.end());
    return std::span(w_.contacts).subspan(first);
  }

  World& world_;
  const SweptSearch& search_;
  StepWorkspace& w_;
  SweptMemory& m_;
};

double energy_of(const World& world, int soft) {
  return energy(world.soft[at(soft)], world.settings.gravity).total();
}

}  // namespace

double resolve_alone_on_ground(World& world, SweptSearch& search, StepWorkspace& workspace) {
  search.mark_candidates();
  AloneOnGround alone(world, search, workspace);
  double gained = 0.0;
  for (int i = 0; i < static_cast<int>(world.soft.size()); ++i) {
    if (!alone.has_any(i)) continue;
    const double before = workspace.options.measure_work ? energy_of(world, i) : 0.0;
    alone.resolve(i);
    if (workspace.options.measure_work) gained += energy_of(world, i) - before;
  }
  return gained;
}

}  // namespace pneuma::sim

#include "sim/step/swept/alone_on_ground.h"

#include <algorithm>
#include <limits>

#include "sim/collision/find_body_contacts.h"
#include "sim/inspect/inspect.h"
#include "sim/response/carried_boxes.h"
#include "sim/response/ground_contact.h"
#include "sim/soft/pins.h"

namespace pneuma::sim {
namespace {

class AloneOnGround {
 public:
  AloneOnGround(World& world, const MotionStart& start, const SweptSearch& search,
                SweptMemory& memory, std::vector<Contact>& contacts)
      : world_(world), start_(start), search_(search), m_(memory), contacts_(contacts) {}

  bool has_any(int soft) const {
    return !is_fixed(world_, soft) &&
           (m_.bodies.is_lone(soft) || m_.on_ground[at(soft)].meets_alone);
  }

  void resolve(int soft) {
    const SoftState& start = start_.soft[at(soft)];
    if (m_.bodies.is_lone(soft)) {
      meet_ground_alone(world_, soft, start, contacts_, m_.before_ground);
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
      on_ground.work += work(soft, start, contact);
      on_ground.is_held = true;
    }
  }

  /// J. The mean force of the step (N), which has sped a vertex up, has moved it too: to put it
  /// back takes what the ground took to stop it, so that none is left at rest. Where the velocity
  /// at the end of a step moves it in all of it, half of that way is no work of the force.
  double work(int soft, const SoftState& start, const Contact& contact) const {
    const SoftBody& body = world_.soft[at(soft)];
    const double mass = body.material.vertex_mass, step = time_step(world_.settings);
    const int v = contact.first.feature.index;
    const Vec3 after = body.velocities[v], before = after - contact.impulse / mass;
    const Vec3 sped_up = before - Vec3(start.velocities[v]);
    Vec3 put_back = Vec3(body.positions[v]) - contact.point;
    if (moves_by_new_velocity(world_.settings.integrator)) put_back += 0.5 * step * sped_up;
    const Vec3 force = mass / step * sped_up;
    return 0.5 * contact.impulse.dot(before + after) - force.dot(put_back);
  }

  std::span<Contact> find_alone(int soft) {
    const std::size_t first = contacts_.size();
    find_soft_ground(world_, soft, contacts_);
    const auto begin = contacts_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = std::remove_if(begin, contacts_.end(), [&](const Contact& contact) {
      return !search_.is_alone(soft, contact.first.feature.index);
    });
    contacts_.erase(end, contacts_.end());
    return std::span(contacts_).subspan(first);
  }

  World& world_;
  const MotionStart& start_;
  const SweptSearch& search_;
  SweptMemory& m_;
  std::vector<Contact>& contacts_;
};

/// Of the distance between two features, by which each side may come nearer to the other.
constexpr double share_of_distance = 0.4;
/// Of the skin: less than this below the ground is left.
constexpr double left_of_skin = 1e-3;
constexpr double any_height = std::numeric_limits<double>::infinity();

class SunkVertices {
 public:
  SunkVertices(World& world, SweptMemory& memory) : world_(world), m_(memory) {}

  void find() {
    m_.sunk.clear();
    for (int i = 0; i < static_cast<int>(world_.soft.size()); ++i) {
      if (m_.bodies.is_lone(i) || !m_.on_ground[at(i)].meets_alone) continue;
      const SoftBody& body = world_.soft[at(i)];
      const double lowest = -left_of_skin * m_.bodies.skin(i);
      for (int v = 0; v < body.positions.size(); ++v) {
        const int node = m_.bodies.node_of(i, v);
        if (body.positions[v].z() >= lowest || m_.is_in_candidate[at(node)] == 0) continue;
        if (!is_pinned(body, v)) m_.sunk.push_back({node, i, v, -body.positions[v].z()});
      }
    }
  }

  bool any() const { return !m_.sunk.empty(); }

  void lift() {
    for (const SweptCandidate& candidate : m_.candidates) {
      if (candidate.bodies.second != swept_ground) leave_room(candidate);
    }
    for (const SunkVertex& sunk : m_.sunk) lift(sunk);
    m_.bodies.set_end(world_);
  }

 private:
  /// m, by which a side may rise whose other side is `towards` above it, of their distance.
  static double room_towards(double towards, double distance) {
    if (distance <= rounding_distance) return 0.0;
    return towards <= 0.0 ? any_height : share_of_distance * distance * distance / towards;
  }

  /// Halfway between the nearest points of two features a plane separates them, to which neither
  /// gets as it rises.
  void leave_room(const SweptCandidate& candidate) {
    const auto [first, second] = candidate.bodies;
    double wanted = 0.0;  // by any of its vertices
    const auto ask = [&](const SunkVertex& sunk) { wanted = std::max(wanted, sunk.room); };
    for_each_sunk({first, candidate.features.first}, ask);
    for_each_sunk({second, candidate.features.second}, ask);
    if (wanted == 0.0) return;
    const auto closest =
        closest_points(m_.bodies.surface(first), m_.bodies.surface(second), candidate.features,
                       Moment::end, wanted / share_of_distance);
    if (!closest) return;
    const double distance = closest->distance;
    const double up = closest->first_point.z() - closest->second_point.z();
    const auto limit = [distance](double towards) {
      const double room = room_towards(towards, distance);
      return [room](SunkVertex& sunk) { sunk.room = std::min(sunk.room, room); };
    };
    for_each_sunk({first, candidate.features.first}, limit(-up));
    for_each_sunk({second, candidate.features.second}, limit(up));
  }

  template <class Visit>
  void for_each_sunk(const SurfacePoint& feature, const Visit& visit) {
    m_.bodies.for_each_node(feature, [&](int node) {
      const auto sunk = std::ranges::lower_bound(m_.sunk, node, {}, &SunkVertex::node);
      if (sunk != m_.sunk.end() && sunk->node == node) visit(*sunk);
    });
  }

  void lift(const SunkVertex& sunk) {
    auto end = world_.soft[at(sunk.soft)].positions[sunk.vertex];
    const Vec3 wanted = end + sunk.room * Vec3::UnitZ();
    end = m_.bodies.within_allowance(sunk.soft, sunk.vertex, end, wanted);
  }

  World& world_;
  SweptMemory& m_;
};

double energy_of(const World& world, int soft) {
  return energy(world.soft[at(soft)], world.settings.gravity).total();
}

}  // namespace

double resolve_alone_on_ground(World& world, const MotionStart& start, SweptSearch& search,
                               SweptMemory& memory, std::vector<Contact>& contacts) {
  search.mark_candidates();
  AloneOnGround alone(world, start, search, memory, contacts);
  double gained = 0.0;
  for (int i = 0; i < static_cast<int>(world.soft.size()); ++i) {
    if (!alone.has_any(i)) continue;
    const double before = memory.measures_work ? energy_of(world, i) : 0.0;
    alone.resolve(i);
    if (memory.measures_work) gained += energy_of(world, i) - before;
  }
  return gained;
}

double lift_sunk_vertices(World& world, SweptMemory& memory) {
  SunkVertices sunk(world, memory);
  sunk.find();
  if (!sunk.any()) return 0.0;
  if (!memory.measures_work) {
    sunk.lift();
    return 0.0;
  }
  const double before = energy(world).total();
  sunk.lift();
  return energy(world).total() - before;
}

void list_held_on_ground(const World& world, const SweptMemory& memory,
                         std::vector<Contact>& contacts) {
  const bool holds = world.settings.ground && is_implicit(world.settings.integrator);
  for (int i = 0; holds && i < static_cast<int>(world.soft.size()); ++i) {
    if (is_fixed(world, i) || memory.bodies.is_lone(i)) continue;
    const auto pressing = static_cast<std::ptrdiff_t>(contacts.size());
    find_soft_ground(world, i, contacts);
    const auto held = contacts.begin() + pressing;
    const auto presses = [&](const Contact& contact) {
      return std::any_of(contacts.begin(), held, [&](const Contact& other) {
        return other.second.kind == SideKind::ground && other.first.kind == SideKind::soft &&
               other.first.body == i && other.first.feature == contact.first.feature;
      });
    };
    contacts.erase(std::remove_if(held, contacts.end(), presses), contacts.end());
  }
}

}  // namespace pneuma::sim

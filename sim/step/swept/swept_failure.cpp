#include "sim/step/swept/swept_failure.h"

#include <algorithm>
#include <utility>

#include "sim/base/text.h"
#include "sim/step/swept/between_walls.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// Of the shortest side of a box that something moved presses on, and no less than the distance
/// that it keeps: it gives way before that if it can.
constexpr double squeezed_depth = 0.02;
/// Cosine of the angle between directions that are against each other.
constexpr double against = -0.5;

class SqueezedBoxes {
 public:
  SqueezedBoxes(const World& world, const SweptMemory& memory)
      : world_(world), m_(memory), bodies_(memory.bodies), contacts_(memory.contacts) {}

  std::optional<Divergence> find(const SweptContact& contact) const {
    const int first = contact.first.body, second = contact.second.body;
    for (const auto& [body, other] : {std::pair(first, second), std::pair(second, first)}) {
      if (!is_free_box(body) || !(other == swept_ground || bodies_.is_rigid(other))) continue;
      const RigidBox& box = world_.rigid[at(bodies_.box(body))];
      // A row shares what it lacks among its gaps.
      const double depth = std::max(-contact.distance, 0.5 * missing_room(world_, m_, contact));
      const double least = std::max(squeezed_depth * box.size.minCoeff(), contact.wanted);
      if (depth <= least || !is_pressed(body) || !is_held(body, contact)) continue;
      Divergence squeezed{Stage::find_contacts, world_.steps + 1, box.name,
                          "it has no room left: it is pressed " + base::text(depth) + " m into " +
                              name(other) + ". Let what is moved leave more room"};
      squeezed.other = name(other);
      return squeezed;
    }
    return std::nullopt;
  }

 private:
  bool is_free_box(int body) const {
    return body != swept_ground && bodies_.is_rigid(body) && !is_kinematic(world_, body);
  }
  bool is_moved(int body) const { return bodies_.pushes(body) && is_kinematic(world_, body); }
  bool is_pressed(int box) const {
    return std::ranges::any_of(contacts_, [&](const SweptContact& contact) {
      return (contact.first.body == box && is_moved(contact.second.body)) ||
             (contact.second.body == box && is_moved(contact.first.body));
    });
  }
  /// On the other side. What only starts in another gets out of it.
  bool is_held(int box, const SweptContact& pressed) const {
    const Vec3 pushed = direction(pressed, box);
    return std::ranges::any_of(contacts_, [&](const SweptContact& contact) {
      const bool is_of_box = contact.first.body == box || contact.second.body == box;
      return is_of_box && contact.is_near && direction(contact, box).dot(pushed) < against;
    });
  }
  /// In which the contact pushes the box.
  static Vec3 direction(const SweptContact& contact, int box) {
    return contact.first.body == box ? contact.normal : Vec3(-contact.normal);
  }
  std::string name(int body) const {
    return body == swept_ground ? "the ground" : world_.rigid[at(bodies_.box(body))].name;
  }

  const World& world_;
  const SweptMemory& m_;
  const SweptBodies& bodies_;
  std::span<const SweptContact> contacts_;
};

}  // namespace

std::optional<Divergence> find_squeezed_box(const World& world, const SweptMemory& memory) {
  if (world.rigid.empty()) return std::nullopt;
  const SqueezedBoxes squeezed(world, memory);
  for (const SweptContact& contact : memory.contacts) {
    if (contact.distance >= 0.0) continue;
    if (auto divergence = squeezed.find(contact)) return divergence;
  }
  return std::nullopt;
}

Divergence of_blocked_bodies(const World& world, const SweptBodies& bodies, const BodyPair& pair) {
  const auto [first, second] = pair;
  const bool any_moved = bodies.pushes(first) || (second != swept_ground && bodies.pushes(second));
  Divergence blocked{
      Stage::resolve_contacts, world.steps + 1, bodies.name(world, first),
      "it cannot be kept from passing through " + bodies.name(world, second) +
          " in parts of the step either" +
          (any_moved ? ". Let what is moved leave more room, or press more slowly" : "")};
  blocked.other = bodies.name(world, second);
  return blocked;
}

Divergence of_added_energy(const World& world, const SweptBodies& bodies,
                           const SweptContact& contact, double energy) {
  Divergence added{Stage::resolve_contacts, world.steps + 1, bodies.name(world, contact.first.body),
                   "its contacts with " + bodies.name(world, contact.second.body) + " add " +
                       base::text(energy) +
                       " J, which is more than their motion against each other can give back"};
  added.other = bodies.name(world, contact.second.body);
  return added;
}

}  // namespace pneuma::sim

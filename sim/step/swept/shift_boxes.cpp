#include "sim/step/swept/shift_boxes.h"

#include <algorithm>
#include <utility>

#include "sim/response/group_motion.h"

namespace pneuma::sim {
namespace {

/// m in a whole step, at most: boxes that start in each other do not jump.
constexpr double max_shift = 0.05;
/// Of the thinnest skin: less is not worth a shift.
constexpr double min_shift = 0.02;
/// Of the greatest shift: to a hundredth of this they are solved for, as velocities of boxes are.
constexpr double shift_tolerance = 0.5;
/// The same: shifts that miss what is wanted by more are none.
constexpr double far_off = 2.0;
/// Of its distance to what is soft: so much nearer a shift may bring a box, where there is no other
/// room.
constexpr double most_of_distance = 0.5;
/// Of the greatest shift: contacts with more room are left out. Only the shifts of a chain of more
/// boxes than that, all of them sunk alike, could take it.
constexpr double room_for_shifts = 20.0;

/// One side is.
bool is_soft(const SweptBodies& bodies, const SweptContact& contact) {
  const auto is_soft = [&](int body) { return body != swept_ground && !bodies.is_rigid(body); };
  return is_soft(contact.first.body) || is_soft(contact.second.body);
}

double shift(double missing, double fraction) {
  return std::min(made_up_per_step * missing, fraction * max_shift);
}

/// Of the shifts that came out, at most 1: what has no room is let through, but not into what is
/// soft.
double part_beside_soft(const SweptMemory& memory) {
  double part = 1.0;
  for (std::size_t i = 0; i < memory.contacts.size(); ++i) {
    const SweptContact& contact = memory.contacts[i];
    if (!is_soft(memory.bodies, contact)) continue;
    const double closer = -contact.normal.dot(memory.impulses[i].change());
    const double kept = most_of_distance * std::min(contact.distance, contact.wanted);
    if (closer > contact.distance - kept) part = std::min(part, (contact.distance - kept) / closer);
  }
  return part;
}

/// Whether the shifts that came out miss what was wanted by more than they could if there were
/// room: no impulse grows in a few iterations as it would between walls, if many boxes are there.
bool are_far_off(const SweptMemory& memory, double greatest) {
  return std::ranges::any_of(memory.impulses, [&](const SweptImpulse& impulse) {
    return impulse.parting() - impulse.normal().dot(impulse.change()) > far_off * greatest;
  });
}

bool has_no_room(const SweptMemory& memory, const SweptContact& contact) {
  return std::ranges::find(memory.without_room, pair_of(contact)) != memory.without_room.end();
}

/// Those that were let go.
void note_without_room(SweptMemory& memory) {
  for (std::size_t i = 0; i < memory.contacts.size(); ++i) {
    const SweptContact& contact = memory.contacts[i];
    if (!memory.impulses[i].only_gives_back() || has_no_room(memory, contact)) continue;
    memory.without_room.push_back(pair_of(contact));
  }
}

/// What a try to shift boxes keeps of the distance wanted: a part; of what has no room what there
/// is; of all what there is.
enum class Keeps { part, part_where_there_is_room, what_there_is };

/// Solves for the shifts as changes of the boxes. Returns whether there is room for them.
bool solve_for_shifts(const World& world, SweptMemory& memory, SweptSearch& search, double fraction,
                      double greatest, Keeps keeps) {
  search.find_contacts_of_boxes(room_for_shifts * greatest);
  memory.impulses.clear();
  for (const SweptContact& contact : memory.contacts) {
    const bool may_touch = keeps == Keeps::what_there_is || has_no_room(memory, contact);
    const double kept = kept_between_walls(world, memory, contact)
                            .value_or(may_touch ? 0.0 : closest_allowed * contact.wanted);
    const double missing = (may_touch ? std::min(0.0, kept) : kept) - contact.distance;
    memory.impulses.push_back(search.motion().impulse(contact, 0.0));
    memory.impulses.back().aim(shift(missing, fraction), Vec3::Zero());
  }
  const std::size_t of_boxes = memory.contacts.size();
  search.find_contacts_beside_boxes(fraction * max_shift);
  for (std::size_t i = of_boxes; i < memory.contacts.size(); ++i) {
    const SweptContact& contact = memory.contacts[i];
    memory.impulses[i].aim(std::min(0.0, contact.wanted - contact.distance), Vec3::Zero());
  }
  return memory.solver.solve_shifts(memory.contacts, memory.impulses, shift_tolerance * greatest);
}

/// Returns how much of the shifts, which are changes of the boxes, they are to take: 0, if none is
/// worth one, if they had to go into what stands still, or if they are not found.
double find_shifts(const World& world, SweptMemory& memory, SweptSearch& search, double fraction) {
  const double greatest = shift(search.greatest_missing_of_boxes(), fraction);
  if (greatest < min_shift * memory.bodies.thinnest_skin()) return 0.0;
  memory.impulses.clear();
  for (const Keeps keeps : {Keeps::part, Keeps::part_where_there_is_room, Keeps::what_there_is}) {
    for (SweptImpulse& impulse : memory.impulses) impulse.replace_given(Vec4d{});
    if (solve_for_shifts(world, memory, search, fraction, greatest, keeps) &&
        !are_far_off(memory, greatest)) {
      return 1.0;
    }
    note_without_room(memory);
  }
  const auto stands_still = [&](const SweptContact& contact) {
    const auto is_still = [&](int body) { return memory.bodies.stands_still(world, body); };
    return is_still(contact.first.body) || is_still(contact.second.body);
  };
  bool has_let_go = false;
  for (std::size_t i = 0; i < memory.contacts.size(); ++i) {
    if (!memory.impulses[i].only_gives_back()) continue;
    if (stands_still(memory.contacts[i])) return 0.0;
    has_let_go = true;
  }
  return has_let_go ? part_beside_soft(memory) : 0.0;
}

/// Finds the boxes that are near each other and nothing else.
void group_near_boxes(SweptMemory& memory) {
  NearGroups& groups = memory.near_groups;
  groups.sets.reset();
  const int held = static_cast<int>(groups.sets.size()) - 1;  // what does not give way
  const auto box = [&](const SurfacePoint& point) { return memory.bodies.box(point.body); };
  for (std::size_t i = 0; i < memory.contacts.size(); ++i) {
    const SweptImpulse& impulse = memory.impulses[i];
    const SweptContact& contact = memory.contacts[i];
    const bool first = impulse.first().moves(), second = impulse.second().moves();
    if (first) groups.sets.unite(box(contact.first), second ? box(contact.second) : held);
    if (second && !first) groups.sets.unite(box(contact.second), held);
  }
  groups.order.clear();
  for (int i = 0; i < held; ++i) {
    if (groups.sets.find(i) != groups.sets.find(held)) groups.order.push_back(i);
  }
  std::ranges::sort(groups.order, {}, [&](int i) { return std::pair(groups.sets.find(i), i); });
}

/// Of the boxes in `memory.members`, which nothing holds. Returns its work.
double give_back_angular_momentum(World& world, SweptMemory& memory, const Vec3& gained) {
  GroupMotion motion(world, memory.members);
  const double before = motion.energy();
  motion.turn(-gained);
  const double work = motion.energy() - before;
  if (!(work > 0.0)) return work;
  motion.leave_out_common();
  return work - motion.take(work);
}

}  // namespace

double keep_angular_momentum(World& world, SweptMemory& memory) {
  if (!memory.bodies.has_shifts()) return 0.0;
  NearGroups& groups = memory.near_groups;
  double work = 0.0;
  for (auto begin = groups.order.begin(); begin != groups.order.end();) {
    const int set = groups.sets.find(*begin);
    memory.members.clear();
    Vec3 gained = Vec3::Zero();
    for (; begin != groups.order.end() && groups.sets.find(*begin) == set; ++begin) {
      memory.members.push_back(memory.bodies.of_box(*begin));
      gained += memory.bodies.angular_momentum_of_shift(world, *begin);
    }
    if (memory.members.size() < 2) continue;
    work += give_back_angular_momentum(world, memory, gained);
  }
  return work;
}

bool shift_near_boxes(World& world, SweptMemory& memory, SweptSearch& search, double fraction) {
  memory.bodies.forget_shifts();
  memory.without_room.clear();
  if (world.rigid.empty()) return false;
  const double part = find_shifts(world, memory, search, fraction);
  if (part > 0.0) {
    group_near_boxes(memory);
    memory.bodies.take_as_shifts(part);
    memory.bodies.shift_boxes(world);
    memory.work += memory.bodies.work_of_shifts(world);
  }
  memory.contacts.clear();  // they are none of the step's motion
  memory.impulses.clear();
  return part > 0.0;
}

}  // namespace pneuma::sim

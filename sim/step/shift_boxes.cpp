#include "sim/step/shift_boxes.h"

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
/// Of the greatest shift: contacts with more room are left out. Only the shifts of a chain of more
/// boxes than that, all of them sunk alike, could take it.
constexpr double room_for_shifts = 20.0;

/// Solves for the shifts as changes of the boxes. Whether any is worth one.
bool find_shifts(SweptMemory& memory, SweptSearch& search, double fraction) {
  const auto shift = [&](double missing) {
    return std::min(made_up_per_step * missing, fraction * max_shift);
  };
  const double greatest = shift(search.greatest_missing_of_boxes());
  if (greatest < min_shift * memory.bodies.thinnest_skin()) return false;
  search.find_contacts_of_boxes(room_for_shifts * greatest);
  memory.impulses.clear();
  for (const SweptContact& contact : memory.contacts) {
    memory.impulses.push_back(search.impulse(contact, 0.0));
    memory.impulses.back().aim(shift(missing_distance(contact)), Vec3::Zero());
  }
  const std::size_t of_boxes = memory.contacts.size();
  search.find_contacts_beside_boxes(fraction * max_shift);
  for (std::size_t i = of_boxes; i < memory.contacts.size(); ++i) {
    const SweptContact& contact = memory.contacts[i];
    memory.impulses[i].aim(std::min(0.0, contact.wanted - contact.distance), Vec3::Zero());
  }
  memory.solver.solve(memory.contacts, memory.impulses, shift_tolerance * greatest);
  return true;
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
  if (world.rigid.empty()) return false;
  const bool shifts = find_shifts(memory, search, fraction);
  if (shifts) {
    group_near_boxes(memory);
    memory.bodies.take_as_shifts();
    memory.bodies.shift_boxes(world);
    memory.work += memory.bodies.work_of_shifts(world);
  }
  memory.contacts.clear();  // they are none of the step's motion
  memory.impulses.clear();
  return shifts;
}

}  // namespace pneuma::sim

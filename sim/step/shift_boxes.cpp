#include "sim/step/shift_boxes.h"

namespace pneuma::sim {
namespace {

/// m in a whole step, at most: boxes that start in each other do not jump.
constexpr double max_shift = 0.05;
/// Of the thinnest skin: less is not worth a shift.
constexpr double min_shift = 0.02;
/// Of the greatest shift: to this they are solved for.
constexpr double shift_tolerance = 0.05;

/// Solves for the shifts as changes of the boxes. Whether any is worth one.
bool find_shifts(SweptMemory& memory, SweptSearch& search, double fraction) {
  search.find_contacts_of_boxes();
  double greatest = 0.0;
  for (std::size_t i = 0; i < memory.contacts.size(); ++i) {
    const double missing = missing_distance(memory.contacts[i]);
    const double shift = std::min(made_up_per_step * missing, fraction * max_shift);
    memory.impulses[i].aim(shift, Vec3::Zero());
    greatest = std::max(greatest, shift);
  }
  if (greatest < min_shift * memory.bodies.thinnest_skin()) return false;
  const std::size_t of_boxes = memory.contacts.size();
  search.find_contacts_beside_boxes(fraction * max_shift);
  for (std::size_t i = of_boxes; i < memory.contacts.size(); ++i) {
    const SweptContact& contact = memory.contacts[i];
    memory.impulses[i].aim(std::min(0.0, contact.wanted - contact.distance), Vec3::Zero());
  }
  memory.solver.solve(memory.contacts, memory.impulses, shift_tolerance * greatest);
  return true;
}

}  // namespace

bool shift_near_boxes(World& world, SweptMemory& memory, SweptSearch& search, double fraction) {
  memory.bodies.forget_shifts();
  if (world.rigid.empty()) return false;
  const bool shifts = find_shifts(memory, search, fraction);
  if (shifts) {
    memory.bodies.take_as_shifts();
    memory.bodies.shift_boxes(world);
    memory.work += memory.bodies.work_of_shifts(world);
  }
  memory.contacts.clear();  // they are none of the step's motion
  memory.impulses.clear();
  return shifts;
}

}  // namespace pneuma::sim

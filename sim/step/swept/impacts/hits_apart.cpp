#include "sim/step/swept/impacts/hits_apart.h"

#include <algorithm>
#include <utility>

#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// What bounces by less loses most of its motion anyway.
constexpr double least_restitution = 0.5;
/// m/s, and of what a step of free fall gains: slower impacts, in a heap that comes to rest, are
/// not worth parts of a step.
constexpr double min_approach = 0.1, least_of_fall = 2.0;
/// Of a step: in parts no longer than this a box that tips hardly changes over too early.
constexpr double least_part_of_tipping = 1.0 / 8.0;
/// Of what a step of free fall gains: with less it does not go on to rock.
constexpr double least_tipping = 0.15;
/// Of a heap of more boxes that bounce at once each step would be halved, for little. A box that
/// loses less than this part of its speed counts for less, and one that keeps all for nothing.
constexpr double most_boxes = 12.0, loss_of_one = 0.1;

/// `visit(partner, other body)` of each side that is a box which moves freely.
template <class Visit>
void for_each_box(const World& world, SweptMemory& memory, const SweptContact& contact,
                  const Visit& visit) {
  const int first = contact.first.body, second = contact.second.body;
  for (const auto& [body, other] : {std::pair(first, second), std::pair(second, first)}) {
    const bool moves = memory.bodies.is_box(body) && !is_fixed(world, body);
    if (moves) visit(memory.partners[at(body)], other);
  }
}

/// `visit(contact)` of both ends of the step.
template <class Visit>
void for_each_contact(const SweptMemory& memory, const Visit& visit) {
  for (const SweptContact& contact : memory.first_contacts) visit(contact);
  for (const SweptContact& contact : memory.contacts) visit(contact);
}

/// Whether a box that hits what stands still has rested on it as well, and touches nothing else.
bool rests_there_alone(const World& world, const SweptMemory& memory, const SweptContact& hit) {
  const auto [first, second] = pair_of(hit);
  const int box = is_fixed(world, first) ? second : first;
  bool has_rested = false, is_alone = true;
  for (const SweptContact& contact : memory.first_contacts) {
    has_rested = has_rested || (contact.is_near && pair_of(contact) == pair_of(hit));
  }
  for_each_contact(memory, [&](const SweptContact& contact) {
    const bool is_of_box = contact.first.body == box || contact.second.body == box;
    is_alone = is_alone && (!is_of_box || pair_of(contact) == pair_of(hit));
  });
  return has_rested && is_alone;
}

}  // namespace

double least_approach(const Settings& settings) {
  return std::max(min_approach, least_of_fall * time_step(settings) * settings.gravity.norm());
}

bool bounces_well(const World& world, const ContactMotion& motion, const SweptContact& contact) {
  return motion.material(contact).restitution > least_restitution &&
         contact.approach > least_approach(world.settings);
}

bool are_few(std::span<const Partner> boxes) {
  double sum = 0.0;
  for (const Partner& box : boxes) {
    if (box.is_hit) sum += std::min(1.0, (1.0 - box.restitution) / loss_of_one);
  }
  return sum <= most_boxes;
}

bool few_touch(std::span<const Partner> boxes) {
  const auto touches = [](const Partner& box) { return box.contacts > 0; };
  return static_cast<double>(std::ranges::count_if(boxes, touches)) <= most_boxes;
}

bool is_hit_twice(const World& world, SweptMemory& memory, const ContactMotion& motion,
                  double fraction) {
  if (fraction <= least_part) return false;
  const auto bounces = [&](const SweptContact& contact) {
    return motion.is_rigid(contact) && motion.material(contact).restitution > least_restitution;
  };
  const double least = least_approach(world.settings);
  const auto meets = [&](const SweptContact& contact) {
    return (is_hit(contact) || !contact.is_near) && contact.approach > least;
  };
  const auto hits = [&](const SweptContact& contact) { return meets(contact) && bounces(contact); };
  if (std::ranges::none_of(memory.contacts, hits)) return false;
  memory.partners.assign(at(memory.bodies.count()), {});
  bool twice = false;
  for (const SweptContact& contact : memory.contacts) {
    if (!meets(contact)) continue;
    const double restitution = motion.material(contact).restitution;
    const bool bounces_back = bounces(contact);
    for_each_box(world, memory, contact, [&](Partner& partner, int other) {
      partner.restitution = std::min(partner.restitution, restitution);
      if (!bounces_back) return;
      partner.is_hit = true;
      twice = twice || (partner.contacts > 0 && partner.body != other);
      partner.body = other;
      ++partner.contacts;
    });
  }
  if (!are_few(memory.partners)) return false;
  for (const SweptContact& contact : memory.contacts) {
    if (!contact.is_new || !bounces(contact)) continue;
    for_each_box(world, memory, contact, [&](const Partner& partner, int other) {
      twice = twice || (partner.contacts > 0 && partner.body != other);
    });
  }
  return twice;
}

bool is_tipped_onto(const World& world, SweptMemory& memory, double fraction) {
  if (fraction <= least_part_of_tipping) return false;
  const double fall = time_step(world.settings) / fraction * world.settings.gravity.norm();
  const auto is_hit = [&](const SweptContact& contact) {
    return contact.stops && contact.approach > least_tipping * fall;
  };
  if (std::ranges::none_of(memory.contacts, is_hit)) return false;
  memory.partners.assign(at(memory.bodies.count()), {});
  for_each_contact(memory, [&](const SweptContact& contact) {
    for_each_box(world, memory, contact, [](Partner& partner, int) { ++partner.contacts; });
  });
  return few_touch(memory.partners) &&
         std::ranges::any_of(memory.contacts, [&](const SweptContact& contact) {
           return is_hit(contact) && rests_there_alone(world, memory, contact);
         });
}

}  // namespace pneuma::sim

#include "sim/step/swept_warm_start.h"

#include <algorithm>

#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// Of the shortest side of a box: points nearer than this are one, a step later.
constexpr double same_contact = 0.05;

auto bodies_of(const SweptContact& contact) {
  return in_order(contact.first.body, contact.second.body);
}

}  // namespace

RigidState SweptWarmStart::state(int box, Moment moment) const {
  if (moment == Moment::start) return start_.rigid[at(box)];
  const RigidBox& now = world_.rigid[at(box)];
  return {now.position, now.orientation, now.velocity, now.angular_velocity};
}

void SweptWarmStart::apply(Moment moment) {
  for (const WarmStartImpulse& resting : world_.warm_start_impulses) {
    if (resting.is_of_start != (moment == Moment::start)) continue;
    if (SweptImpulse* impulse = find(resting, moment)) impulse->warm_start(resting.impulse);
  }
}

SweptImpulse* SweptWarmStart::find(const WarmStartImpulse& resting, Moment moment) {
  const RigidState box = state(resting.first, moment);
  const Vec3 point = box.position + box.orientation * resting.point;
  double nearest = same_contact * world_.rigid[at(resting.first)].size.minCoeff();
  SweptImpulse* found = nullptr;
  const auto pair = in_order(m_.bodies.of_box(resting.first), m_.bodies.of_box(resting.second));
  for (auto i = std::ranges::lower_bound(m_.contacts, pair, {}, bodies_of);
       i != m_.contacts.end() && bodies_of(*i) == pair; ++i) {
    const double distance = (i->first.point - point).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    found = &m_.impulses[static_cast<std::size_t>(i - m_.contacts.begin())];
  }
  return found;
}

void SweptWarmStart::remember() {
  std::erase_if(world_.warm_start_impulses, [&](const WarmStartImpulse& impulse) {
    return !is_asleep(world_, m_.bodies.of_box(impulse.first)) &&
           !(impulse.second >= 0 && is_asleep(world_, m_.bodies.of_box(impulse.second)));
  });
  remember(m_.first_contacts, m_.first_impulses, Moment::start);
  remember(m_.contacts, m_.impulses, Moment::end);
}

void SweptWarmStart::remember(std::span<const SweptContact> contacts,
                              std::span<const SweptImpulse> impulses, Moment moment) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto& [first, second] = std::tie(contacts[i].first, contacts[i].second);
    const bool on_ground = second.body == swept_ground;
    if (!is_box(first.body) || !(on_ground || is_box(second.body))) continue;
    if (impulses[i].normal_impulse() == 0.0) continue;
    // What stopped a box on its way is not needed again.
    if (moment == Moment::start && !contacts[i].is_near) continue;
    const int box = m_.bodies.box(first.body);
    const RigidState lies = state(box, moment);
    world_.warm_start_impulses.push_back(
        {box, on_ground ? -1 : m_.bodies.box(second.body),
         lies.orientation.conjugate() * (first.point - lies.position), impulses[i].given(),
         moment == Moment::start});
  }
}

}  // namespace pneuma::sim

#include "sim/step/potential_excess.h"

#include <algorithm>
#include <cstdint>

#include "sim/response/group_motion.h"

namespace pneuma::sim {
namespace {

class PotentialExcess {
 public:
  PotentialExcess(World& world, PotentialMemory& memory) : world_(world), m_(memory) {}

  void take(double excess) {
    join_bodies_in_contact();
    double of_vibrations = 0.0, of_groups = 0.0;
    for_each_vibration([&](const GroupMotion& motion) { of_vibrations += motion.energy(); });
    if (excess <= of_vibrations) {
      const double share = excess / of_vibrations;
      for_each_vibration([&](GroupMotion& motion) { motion.take(share * motion.energy()); });
      return;
    }
    for_each_group([&](const GroupMotion& motion) { of_groups += motion.energy(); });
    const double share = of_groups > excess ? excess / of_groups : 1.0;
    for_each_group([&](GroupMotion& motion) { excess -= motion.take(share * motion.energy()); });
    if (share == 1.0) GroupMotion(world_, m_.movable).take(excess);
  }

 private:
  /// Not through what is moved or stands still, which holds them as the ground does, and pins.
  void join_bodies_in_contact() {
    m_.find_contacts_at(m_.end);
    m_.joined.reset();
    std::ranges::fill(m_.touches, std::uint8_t{0});
    std::ranges::fill(m_.is_held, std::uint8_t{0});
    for (const ActiveContact& contact : m_.active) {
      const bool on_ground = contact.second < 0;
      const bool first_moves = !is_kinematic(world_, contact.first);
      const bool second_moves = !on_ground && !is_kinematic(world_, contact.second);
      if (first_moves) m_.touches[at(contact.first)] = 1;
      if (second_moves) m_.touches[at(contact.second)] = 1;
      if (first_moves && second_moves) m_.joined.unite(contact.first, contact.second);
      if (first_moves && !second_moves) m_.is_held[at(contact.first)] = 1;
      if (second_moves && !first_moves) m_.is_held[at(contact.second)] = 1;
    }
    for (const int body : m_.movable) {
      const bool has_pins = body < soft_count(world_) && world_.soft[at(body)].pins;
      if (has_pins || m_.is_held[at(body)] != 0) m_.is_held[at(m_.joined.find(body))] = 1;
    }
  }

  /// `visit(motion)` of each group in contact: what is held has no common motion.
  template <class Visit>
  void for_each_group(const Visit& visit) {
    for (const int& first : m_.movable) {
      if (m_.touches[at(first)] == 0 || m_.joined.find(first) != first) continue;
      m_.group.clear();
      for (const int body : m_.movable) {
        if (m_.joined.find(body) == first) m_.group.push_back(body);
      }
      GroupMotion motion(world_, m_.group);
      if (m_.is_held[at(first)] == 0) motion.leave_out_common();
      visit(motion);
    }
  }

  /// Of what is pinned, all motion is.
  template <class Visit>
  void for_each_vibration(const Visit& visit) {
    for (const int& body : m_.movable) {
      if (body >= soft_count(world_)) return;
      GroupMotion motion(world_, {&body, 1});
      if (!world_.soft[at(body)].pins) motion.leave_out_common();
      visit(motion);
    }
  }

  World& world_;
  PotentialMemory& m_;
};

}  // namespace

void take_excess(World& world, PotentialMemory& memory, double excess) {
  PotentialExcess(world, memory).take(excess);
}

}  // namespace pneuma::sim

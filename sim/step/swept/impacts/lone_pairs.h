// Pairs of bodies that meet nothing else in a step, but for a floor that a box slides on. Private
// to sim/step.
#pragma once

#include <optional>

#include "sim/step/swept/contact_motion.h"
#include "sim/step/swept/swept_memory.h"
#include "sim/swept/impact_side.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {

/// Of the contacts of the start, in the memory. Fills its `partners`.
class LonePairs {
 public:
  /// Refers to all of them.
  LonePairs(const World& world, SweptMemory& memory, const MotionStart& start,
            const ContactMotion& motion)
      : world_(world), m_(memory), start_(start), motion_(motion) {}

  /// For each contact that is the first of such a pair. `meet` may change the contacts.
  template <class Meet>
  void for_each(const Meet& meet) {
    bool any = false;
    for (const SweptContact& contact : m_.contacts) any = any || may_hit(contact);
    if (!any) return;
    find_partners();
    for (std::size_t i = 0; i < m_.contacts.size(); ++i) {
      if (may_hit(m_.contacts[i]) && is_first_of_lone_pair(i)) meet(m_.contacts[i]);
    }
  }

  bool moves_freely(int body) const { return m_.bodies.is_box(body) && !is_fixed(world_, body); }
  /// It keeps where it is, or is moved, whatever hits it.
  bool is_wall(int body) const;
  /// Nothing moves it in this step, as it is static, asleep or the ground.
  bool stands(int body) const;

  /// Of a box that moves freely: `visit(contact, other body)`.
  template <class Visit>
  void for_each_contact(int body, const Visit& visit) const {
    const Partner& partner = m_.partners[at(body)];
    std::size_t i = partner.first_contact;
    for (int left = partner.contacts; left > 0; ++i) {
      const SweptContact& contact = m_.contacts[i];
      if (contact.first.body != body && contact.second.body != body) continue;
      --left;
      visit(i, contact.first.body == body ? contact.second.body : contact.first.body);
    }
  }
  /// Whether the other bears it: it neither comes to it nor leaves it, but for speed_of_rest.
  bool rests(const SweptContact& contact, int other) const;
  /// Whether anything does one of the sides.
  bool is_on_floor(const SweptContact& contact) const;
  bool rests_on(int body, int other) const;
  /// By gravity along the normal: then the end of a step may be where the sides come to rest.
  bool is_pulled(const SweptContact& contact) const;

  ImpactSide side(int body, const ImpactFloor& floor = {}) const;
  /// With the floor that it slides on with a face. None if it tilts there, lies on an edge, or on
  /// several floors.
  std::optional<ImpactSide> side_on_floor(int body) const;
  /// Whether one of them passes over the other, which is level with its floor.
  static bool are_level(const std::array<ImpactSide, 2>& sides, const SweptContact& contact);

 private:
  bool may_hit(const SweptContact& contact) const;
  void find_partners();
  void add_contact(std::size_t number, int body, Partner& partner) const;
  bool meets_only(int body, int other) const;
  bool is_first_of_lone_pair(std::size_t number) const;
  bool lies_flat(int body, int floor, const Vec3& up) const;

  const World& world_;
  SweptMemory& m_;
  const MotionStart& start_;
  const ContactMotion& motion_;
};

}  // namespace pneuma::sim

// Which contacts of a step feel each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/response/contact_impulse.h"

namespace pneuma::sim {

/// Most vertices that lie on the ground touch nothing else: one correction of such a contact is
/// exact, and no other contact notices it.
class ContactCoupling {
 public:
  explicit ContactCoupling(const World& world);

  /// `impulses` are those of `contacts`, and stay where they are for as long as the parts are used.
  void part(std::span<const Contact> contacts, std::span<ContactImpulse> impulses);

  std::span<ContactImpulse* const> alone() const { return alone_; }
  std::span<ContactImpulse* const> coupled() const { return coupled_; }

 private:
  void mark(const ContactSide& side, std::uint8_t mark);
  void mark_coupled(std::span<const Contact> contacts, std::uint8_t mark);

  std::vector<const MeshTopology*> topologies_;       // of the soft bodies
  std::vector<std::vector<std::uint8_t>> is_shared_;  // per vertex; all 0 between calls
  std::vector<ContactImpulse*> alone_;
  std::vector<ContactImpulse*> coupled_;
};

/// Of a vertex of a soft body on the ground.
inline bool is_soft_ground(const Contact& contact) {
  return contact.first.kind == BodyKind::soft && contact.second.kind == BodyKind::ground;
}

}  // namespace pneuma::sim

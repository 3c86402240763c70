#include "sim/response/contact_coupling.h"

namespace pneuma::sim {

ContactCoupling::ContactCoupling(const World& world) {
  for (const SoftBody& body : world.soft) {
    topologies_.push_back(&body.mesh->topology);
    is_shared_.emplace_back(at(body.positions.size()));
  }
}

void ContactCoupling::mark(const ContactSide& side, std::uint8_t mark) {
  if (side.kind != BodyKind::soft) return;
  for (const int v : topologies_[at(side.body)]->feature_vertices(side.feature)) {
    is_shared_[at(side.body)][at(v)] = mark;
  }
}

void ContactCoupling::mark_coupled(std::span<const Contact> contacts, std::uint8_t value) {
  for (const Contact& contact : contacts) {
    if (is_soft_ground(contact)) continue;
    mark(contact.first, value);
    mark(contact.second, value);
  }
}

void ContactCoupling::part(std::span<const Contact> contacts, std::span<ContactImpulse> impulses) {
  alone_.clear();
  coupled_.clear();
  mark_coupled(contacts, 1);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactSide& side = contacts[i].first;
    const bool is_alone =
        is_soft_ground(contacts[i]) && is_shared_[at(side.body)][at(side.feature.index)] == 0;
    (is_alone ? alone_ : coupled_).push_back(&impulses[i]);
  }
  mark_coupled(contacts, 0);
}

}  // namespace pneuma::sim

#include "sim/response/contact_islands.h"

#include <algorithm>

namespace pneuma::sim {

ContactIslands::ContactIslands(const World& world) : box_contact_(world.rigid.size(), -1) {
  for (const SoftBody& body : world.soft) {
    topologies_.push_back(&body.mesh->topology);
    vertex_contact_.emplace_back(at(body.positions.size()), -1);
  }
}

std::span<const int> ContactIslands::island(int island) const {
  return ordered().subspan(at(begin(island)), at(begin(island + 1) - begin(island)));
}

/// Calls visit(entry) for the entry of every vertex of the side, or of its box.
template <class Visit>
void ContactIslands::for_nodes(const ContactSide& side, const Visit& visit) {
  if (side.kind == BodyKind::rigid) visit(box_contact_[at(side.body)]);
  if (side.kind != BodyKind::soft) return;
  for (const int v : topologies_[at(side.body)]->feature_vertices(side.feature)) {
    visit(vertex_contact_[at(side.body)][at(v)]);
  }
}

int ContactIslands::root(int contact) {
  while (parent_[at(contact)] != contact) {
    parent_[at(contact)] = parent_[at(parent_[at(contact)])];
    contact = parent_[at(contact)];
  }
  return contact;
}

void ContactIslands::join(int contact, const ContactSide& side) {
  for_nodes(side, [&](int& known) {
    if (known < 0) {
      known = contact;
      return;
    }
    const int a = root(known), b = root(contact);
    parent_[at(std::max(a, b))] = std::min(a, b);
  });
}

/// Vertices on the ground come after all others, when it is known whether something else has them.
void ContactIslands::collect_members(std::span<const Contact> contacts) {
  const int count = static_cast<int>(contacts.size());
  parent_.resize(contacts.size());
  alone_.clear();
  members_.clear();
  for (int i = 0; i < count; ++i) {
    parent_[at(i)] = i;
    if (is_soft_ground(contacts[at(i)])) continue;
    join(i, contacts[at(i)].first);
    join(i, contacts[at(i)].second);
  }
  for (int i = 0; i < count; ++i) {
    const ContactSide& side = contacts[at(i)].first;
    const bool is_alone = is_soft_ground(contacts[at(i)]) &&
                          vertex_contact_[at(side.body)][at(side.feature.index)] < 0;
    (is_alone ? alone_ : members_).push_back(i);
    if (!is_alone && is_soft_ground(contacts[at(i)])) join(i, side);
  }
}

/// By counting.
void ContactIslands::sort_members() {
  island_.resize(parent_.size());
  next_.clear();
  for (const int i : members_) {
    if (root(i) == i) {
      island_[at(i)] = static_cast<int>(next_.size());
      next_.push_back(0);
    }
    ++next_[at(island_[at(root(i))])];
  }
  start_.assign(1, 0);
  for (int& next : next_) {
    const int first = start_.back();
    start_.push_back(first + next);
    next = first;
  }
  ordered_.resize(members_.size());
  for (const int i : members_) ordered_[at(next_[at(island_[at(root(i))])]++)] = i;
}

void ContactIslands::forget(std::span<const Contact> contacts) {
  for (const int i : members_) {
    for_nodes(contacts[at(i)].first, [](int& known) { known = -1; });
    for_nodes(contacts[at(i)].second, [](int& known) { known = -1; });
  }
}

void ContactIslands::divide(std::span<const Contact> contacts) {
  collect_members(contacts);
  sort_members();
  forget(contacts);
}

}  // namespace pneuma::sim

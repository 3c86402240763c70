#include "sim/response/contact_islands.h"

#include <algorithm>

namespace pneuma::sim {

ContactIslands::ContactIslands(const World& world) {
  std::size_t nodes = world.rigid.size();
  for (const SoftBody& body : world.soft) {
    topologies_.push_back(&body.mesh->topology);
    first_node_.push_back(static_cast<int>(nodes));
    nodes += at(body.positions.size());
  }
  node_contact_.assign(nodes, -1);
}

std::span<const int> ContactIslands::island(int island) const {
  return ordered().subspan(at(begin(island)), at(begin(island + 1) - begin(island)));
}

/// Calls visit(entry) for the entry of every vertex of the side, or of its box.
template <class Visit>
void ContactIslands::for_nodes(const ContactSide& side, const Visit& visit) {
  if (side.kind == SideKind::rigid) visit(node_contact_[at(side.body)]);
  if (side.kind != SideKind::soft) return;
  int* const nodes = &node_contact_[at(first_node_[at(side.body)])];
  for (const int v : topologies_[at(side.body)]->feature_vertices(side.feature)) visit(nodes[v]);
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
    const int own = root(contact);
    const int other = known < 0 ? own : root(known);
    known = std::min(own, other);
    parent_[at(std::max(own, other))] = known;
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
    if (!is_soft_ground(contacts[at(i)])) {
      members_.push_back(i);
      continue;
    }
    const ContactSide& side = contacts[at(i)].first;
    const int known = node_contact_[at(first_node_[at(side.body)] + side.feature.index)];
    (known < 0 ? alone_ : members_).push_back(i);
    if (known >= 0) join(i, side);
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

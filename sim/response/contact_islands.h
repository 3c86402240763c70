// Which contacts of a step feel each other.
#pragma once

#include <span>
#include <vector>

#include "sim/collision/contact.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// Of a vertex of a soft body on the ground.
inline bool is_soft_ground(const Contact& contact) {
  return contact.first.kind == SideKind::soft && contact.second.kind == SideKind::ground;
}

/// Contacts that share a box or a soft body's vertex, directly or through others, make an island:
/// what happens in one does not reach another within the step, so that each is resolved for itself,
/// for as long as it needs, by any thread (ERRATA row 57). Most vertices that lie on the ground
/// touch nothing else: they are kept apart, as what such a contact does is known in closed form
/// (sim/response/vertex_on_ground.h, ERRATA row 31).
class ContactIslands {
 public:
  explicit ContactIslands(const World& world);

  /// Contacts are known by their numbers in `contacts` from here on.
  void divide(std::span<const Contact> contacts);

  /// Soft vertices on the ground that touch nothing else.
  std::span<const int> alone() const { return alone_; }

  int count() const { return static_cast<int>(start_.size()) - 1; }
  /// The contacts of an island in the order in which they were found: what `ordered` has from
  /// begin(island) on.
  std::span<const int> island(int island) const;
  int begin(int island) const { return start_[at(island)]; }
  /// All but those alone, island by island.
  std::span<const int> ordered() const { return ordered_; }

 private:
  template <class Visit>
  void for_nodes(const ContactSide& side, const Visit& visit);
  void join(int contact, const ContactSide& side);
  int root(int contact);
  void collect_members(std::span<const Contact> contacts);
  void sort_members();
  void forget(std::span<const Contact> contacts);

  std::vector<const MeshTopology*> topologies_;  // of the soft bodies
  std::vector<int> first_node_;                  // per soft body: that of its first vertex
  std::vector<int> node_contact_;  // of boxes, then of vertices: a contact there; -1 between calls
  std::vector<int> parent_;        // per contact, towards the first contact of its island
  std::vector<int> island_;        // per contact, of the first of an island
  std::vector<int> members_;
  std::vector<int> alone_;
  std::vector<int> ordered_;
  std::vector<int> start_{0};
  std::vector<int> next_;
};

}  // namespace pneuma::sim

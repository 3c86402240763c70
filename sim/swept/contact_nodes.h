// What the impulses of a contact problem move: boxes and vertices, in an order in which those that
// touch each other are near each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/swept/swept_impulse.h"

namespace pneuma::sim {

/// A box, with six unknowns: the changes of its velocity and of its angular velocity; or a vertex
/// of a soft body, with three.
struct ContactNode {
  BoxChange* box = nullptr;
  double* vertex = nullptr;  // its change, m/s
  double vertex_mass = 0.0;  // kg
  int row = 0;               // of the first unknown

  int rows() const { return box ? 6 : 3; }
};

/// The part of a node in a contact's relative velocity: weight (v + w x arm).
struct ContactLever {
  int node = 0;
  double weight = 1.0;      // < 0 on the second side
  Vec3 arm = Vec3::Zero();  // m, of a box
};

class ContactNodes {
 public:
  /// Of these impulses.
  void find(std::span<SweptImpulse* const> impulses);

  std::span<const ContactNode> nodes() const { return nodes_; }
  /// Of one impulse.
  std::span<const ContactLever> levers(std::size_t impulse) const {
    return std::span(levers_).subspan(begin_[impulse], begin_[impulse + 1] - begin_[impulse]);
  }
  /// Of all impulses, one after the other, and where those of one begin.
  std::span<const ContactLever> levers() const { return levers_; }
  std::size_t first_lever(std::size_t impulse) const { return begin_[impulse]; }
  std::size_t impulses() const { return begin_.size() - 1; }
  int rows() const { return rows_; }
  /// Of each row of the matrix that couples the nodes of every impulse: the column of the first
  /// entry.
  void first_columns(std::vector<int>& columns) const;

 private:
  struct Found {
    const void* key = nullptr;
    int lever = 0;
  };

  void collect(std::span<SweptImpulse* const> impulses);
  void give_numbers();
  void find_neighbours();
  void order();

  std::vector<ContactNode> nodes_;
  std::vector<ContactLever> levers_;
  std::vector<std::size_t> begin_;  // of each impulse's levers
  int rows_ = 0;
  // Scratch.
  std::vector<Found> found_;
  std::vector<int> first_lever_;  // that has the same node, of each lever
  std::vector<int> neighbour_begin_, neighbours_, filled_;
  std::vector<int> queue_;
  std::vector<std::uint8_t> is_queued_;
};

}  // namespace pneuma::sim

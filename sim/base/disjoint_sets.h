// Which of some numbered things belong together.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace pneuma::base {

/// Sets of the numbers 0 to size - 1, each known by its smallest member. Allocates only to grow.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size = 0) : parents_(size) { reset(); }

  /// Each number is a set of its own.
  void reset() { std::iota(parents_.begin(), parents_.end(), 0); }
  /// So is this one, if that is done to all of its set.
  void reset(int member) { parent(member) = member; }
  std::size_t size() const { return parents_.size(); }
  /// The smallest member of the set that a number is in.
  int find(int member) {
    while (parent(member) != member) {
      parent(member) = parent(parent(member));
      member = parent(member);
    }
    return member;
  }
  void unite(int one, int other) {
    one = find(one);
    other = find(other);
    parent(std::max(one, other)) = std::min(one, other);
  }

 private:
  int& parent(int member) { return parents_[static_cast<std::size_t>(member)]; }

  std::vector<int> parents_;
};

}  // namespace pneuma::base

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
  explicit DisjointSets(std::size_t size = 0) : parents_(size) { part(); }

  /// Each number is a set of its own.
  void part() { std::iota(parents_.begin(), parents_.end(), 0); }
  std::size_t size() const { return parents_.size(); }
  /// The smallest member of the set that a number is in.
  int first(int member) {
    while (parent(member) != member) {
      parent(member) = parent(parent(member));
      member = parent(member);
    }
    return member;
  }
  void join(int one, int other) {
    one = first(one);
    other = first(other);
    parent(std::max(one, other)) = std::min(one, other);
  }

 private:
  int& parent(int member) { return parents_[static_cast<std::size_t>(member)]; }

  std::vector<int> parents_;
};

}  // namespace pneuma::base

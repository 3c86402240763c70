// Many bodies in groups of neighbours, so that what is far away is looked at by groups.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "render/light/elements.h"

namespace pneuma::render {

/// Halves of halves of the bodies (Barnes and Hut, "A hierarchical O(N log N) force-calculation
/// algorithm", 1986, for light instead of gravity).
class BodyTree {
 public:
  /// A ball with the area of all bodies of a group and the mean of what they send.
  struct Group {
    Element whole;
    float radius;       // m about the ball's centre, of all elements
    std::size_t body;   // of a group of one
    std::size_t after;  // the next group that is not part of this one
    bool is_one() const { return body != none; }
  };
  static constexpr std::size_t none = ~std::size_t{0};

  void clear();
  void add(BodyElements body) { bodies_.push_back(std::move(body)); }
  /// Of all bodies added since clear().
  void build();

  std::span<const BodyElements> bodies() const { return bodies_; }
  /// A group, then its halves. Empty of bodies that are too few for groups to be worth it.
  std::span<const Group> groups() const { return groups_; }

 private:
  void add_group(std::span<std::size_t> members);

  std::vector<BodyElements> bodies_;
  std::vector<Group> groups_;
};

}  // namespace pneuma::render

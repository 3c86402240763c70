// A bounding hierarchy of a surface's triangles: which of them lie near a box of space.
//
// The simulation has another one, sim/swept/surface_tree.h, which follows a body as it moves. This
// one is built from nothing for each look, and is apart from that on purpose: what is measured
// here, crossings and depths, is what the contacts found there are judged by.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "sim/base/orientation.h"
#include "sim/inspect/closed_surface.h"

namespace pneuma::sim {

/// A box of space with its sides along the axes.
struct Extent {
  base::Point low = {inf, inf, inf};
  base::Point high = {-inf, -inf, -inf};

  void include(const base::Point& point) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], point[k]);
      high[k] = std::max(high[k], point[k]);
    }
  }
  /// Whether they share a point, if only of their sides.
  bool meets(const Extent& other) const {
    return low[0] <= other.high[0] && other.low[0] <= high[0] && low[1] <= other.high[1] &&
           other.low[1] <= high[1] && low[2] <= other.high[2] && other.low[2] <= high[2];
  }

 private:
  static constexpr double inf = std::numeric_limits<double>::infinity();
};

/// A binary tree of boxes, each about the boxes below it; every split halves the triangles by their
/// middles along the longest side.
class TriangleTree {
 public:
  /// Refers to nothing. Of a surface whose points are not all finite the tree is empty.
  explicit TriangleTree(const ClosedSurface& surface);

  /// Of the whole surface.
  const Extent& extent() const { return extent_; }

  /// Calls visit(triangle) for every triangle whose own box meets `extent`, and a few more.
  template <class Visit>
  void for_each_near(const Extent& extent, const Visit& visit) const {
    for (std::size_t i = 0; i < nodes_.size();) {
      const Node& node = nodes_[i];
      const bool near = node.extent.meets(extent);
      if (near && node.first != node.end) {
        for (int t = node.first; t < node.end; ++t) visit(order_[at(t)]);
      }
      i = near ? i + 1 : node.next;
    }
  }

 private:
  /// In depth-first order: the first child follows its parent.
  struct Node {
    Extent extent;
    std::size_t next = 0;  // the node after all below this one
    int first = 0;         // into order_: the triangles of a leaf; of others an empty range
    int end = 0;
  };

  struct Item {
    Extent extent;
    base::Point middle;
    int triangle;
  };

  void build(std::vector<Item>& items, int first, int end);

  std::vector<Node> nodes_;
  std::vector<int> order_;  // triangles, leaf by leaf
  Extent extent_;
};

}  // namespace pneuma::sim

#include "assets/self_touching.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "assets/simplify/grid_triangle.h"
#include "sim/mesh/measure.h"

namespace pneuma::assets {
namespace {

using sim::at;

/// About 20 s. An evenly meshed closed surface has some thirty pairs per triangle whose boxes
/// overlap; only triangles laid across each other in masses come here.
constexpr std::size_t most_pairs = 200'000'000;

std::vector<base::GridPoint> to_grid(const std::vector<Vec3>& vertices) {
  sim::Bounds box;
  for (const Vec3& vertex : vertices) box.include(vertex);
  const double extent = box.size().maxCoeff();
  std::vector<base::GridPoint> points;
  points.reserve(vertices.size());
  for (const Vec3& vertex : vertices) {
    base::GridPoint point;
    for (int axis = 0; axis < 3; ++axis) {
      const double fraction = (vertex[axis] - box.low[axis]) / extent;
      point[at(axis)] = std::llround(fraction * static_cast<double>(base::grid_steps));
    }
    points.push_back(point);
  }
  return points;
}

/// A binary tree of boxes over the triangles, each half of its triangles in either branch.
class Tree {
 public:
  explicit Tree(std::vector<GridBox> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    nodes_.reserve(2 * boxes_.size() / leaf_size + 2);
    build(0, order_.size());
  }

  /// Calls `visit(a, b)` for each two boxes that overlap, until it says false.
  template <class Visit>
  bool visit_pairs(const Visit& visit) const {
    std::vector<std::pair<int, int>> open = {{0, 0}};
    while (!open.empty()) {
      const auto [a, b] = open.back();
      open.pop_back();
      const Node &left = nodes_[at(a)], &right = nodes_[at(b)];
      if (!left.box.overlaps(right.box)) continue;
      if (left.is_leaf() && right.is_leaf()) {
        if (!visit_leaves(left, right, a == b, visit)) return false;
      } else if (a == b) {
        open.insert(
            open.end(),
            {{left.first, left.first}, {left.first, left.second}, {left.second, left.second}});
      } else if (right.is_leaf() || (!left.is_leaf() && left.count() > right.count())) {
        open.insert(open.end(), {{left.first, b}, {left.second, b}});
      } else {
        open.insert(open.end(), {{a, right.first}, {a, right.second}});
      }
    }
    return true;
  }

 private:
  static constexpr std::size_t leaf_size = 4;

  struct Node {
    GridBox box;
    std::size_t begin = 0, end = 0;  // in order_
    int first = -1, second = -1;     // branches
    bool is_leaf() const { return first < 0; }
    std::size_t count() const { return end - begin; }
  };

  int build(std::size_t begin, std::size_t end) {
    const int index = static_cast<int>(nodes_.size());
    Node node;
    node.begin = begin;
    node.end = end;
    for (std::size_t i = begin; i < end; ++i) node.box.include(boxes_[at(order_[i])]);
    nodes_.push_back(node);
    if (end - begin <= leaf_size) return index;
    const std::size_t middle = begin + (end - begin) / 2;
    split(node.box, begin, middle, end);
    const int first = build(begin, middle);
    const int second = build(middle, end);
    nodes_[at(index)].first = first;
    nodes_[at(index)].second = second;
    return index;
  }

  /// By the boxes' middles along the longest axis, so that the tree is as deep as its count says.
  void split(const GridBox& box, std::size_t begin, std::size_t middle, std::size_t end) {
    std::size_t axis = 0;
    for (std::size_t i = 1; i < 3; ++i) {
      if (box.high[i] - box.low[i] > box.high[axis] - box.low[axis]) axis = i;
    }
    const auto start = order_.begin();
    using Offset = std::vector<int>::difference_type;
    std::nth_element(start + static_cast<Offset>(begin), start + static_cast<Offset>(middle),
                     start + static_cast<Offset>(end), [&](int a, int b) {
                       const GridBox &left = boxes_[at(a)], &right = boxes_[at(b)];
                       return left.low[axis] + left.high[axis] < right.low[axis] + right.high[axis];
                     });
  }

  template <class Visit>
  bool visit_leaves(const Node& left, const Node& right, bool same, const Visit& visit) const {
    for (std::size_t i = left.begin; i < left.end; ++i) {
      for (std::size_t j = same ? i + 1 : right.begin; j < right.end; ++j) {
        if (!boxes_[at(order_[i])].overlaps(boxes_[at(order_[j])])) continue;
        if (!visit(order_[i], order_[j])) return false;
      }
    }
    return true;
  }

  std::vector<GridBox> boxes_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace

SelfTouching find_self_touching(const sim::TriangleMesh& mesh, std::size_t max_places) {
  SelfTouching result;
  if (mesh.triangles.empty()) return result;
  const std::vector<base::GridPoint> points = to_grid(mesh.vertices);
  std::vector<GridTriangle> triangles;
  std::vector<GridBox> boxes;
  for (const Triangle& triangle : mesh.triangles) {
    const auto& [a, b, c] = triangle;
    triangles.push_back({triangle, {points[at(a)], points[at(b)], points[at(c)]}});
    boxes.push_back(box_of(triangles.back()));
  }
  std::size_t pairs = 0;
  result.complete = Tree(std::move(boxes)).visit_pairs([&](int s, int t) {
    if (++pairs > most_pairs) return false;
    const GridTriangle &first = triangles[at(s)], &second = triangles[at(t)];
    if (is_flat(first) || is_flat(second) || !touch(first, second)) return true;
    ++result.count;
    result.first.push_back({std::min(s, t), std::max(s, t)});
    if (result.first.size() >= 2 * max_places + 100) {
      std::sort(result.first.begin(), result.first.end());
      result.first.resize(max_places);
    }
    return true;
  });
  std::sort(result.first.begin(), result.first.end());
  if (result.first.size() > max_places) result.first.resize(max_places);
  return result;
}

}  // namespace pneuma::assets

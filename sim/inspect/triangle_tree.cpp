#include "sim/inspect/triangle_tree.h"

#include <cmath>

namespace pneuma::sim {
namespace {

constexpr int leaf_triangles = 4;

bool all_finite(const std::vector<base::Point>& points) {
  return std::all_of(points.begin(), points.end(), [](const base::Point& p) {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
  });
}

std::size_t longest_side(const Extent& extent) {
  const auto side = [&](std::size_t k) { return extent.high[k] - extent.low[k]; };
  if (side(0) >= side(1) && side(0) >= side(2)) return 0;
  return side(1) >= side(2) ? 1 : 2;
}

}  // namespace

TriangleTree::TriangleTree(const ClosedSurface& surface) {
  if (surface.triangles.empty() || !all_finite(surface.points)) return;
  std::vector<Item> items;
  items.reserve(surface.triangles.size());
  for (const Triangle& triangle : surface.triangles) {
    Item item{{}, {}, static_cast<int>(items.size())};
    for (const int v : triangle) item.extent.include(surface.points[at(v)]);
    for (std::size_t k = 0; k < 3; ++k) {
      item.middle[k] = 0.5 * item.extent.low[k] + 0.5 * item.extent.high[k];
    }
    items.push_back(item);
  }
  const int count = static_cast<int>(items.size());
  nodes_.reserve(at(count));
  build(items, 0, count);
  order_.reserve(items.size());
  for (const Item& item : items) order_.push_back(item.triangle);
  extent_ = nodes_.front().extent;
}

void TriangleTree::build(std::vector<Item>& items, int first, int end) {
  const std::size_t node = nodes_.size();
  nodes_.emplace_back();
  Extent extent, middles;
  for (int i = first; i < end; ++i) {
    extent.include(items[at(i)].extent.low);
    extent.include(items[at(i)].extent.high);
    middles.include(items[at(i)].middle);
  }
  nodes_[node].extent = extent;
  if (end - first <= leaf_triangles) {
    nodes_[node].first = first;
    nodes_[node].end = end;
  } else {
    const std::size_t axis = longest_side(middles);
    const int half = first + (end - first) / 2;
    std::nth_element(
        items.begin() + first, items.begin() + half, items.begin() + end,
        [axis](const Item& a, const Item& b) { return a.middle[axis] < b.middle[axis]; });
    build(items, first, half);
    build(items, half, end);
  }
  nodes_[node].next = nodes_.size();
}

}  // namespace pneuma::sim

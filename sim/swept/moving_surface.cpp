#include "sim/swept/moving_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace pneuma::sim {
namespace {

/// Goes down two trees, or one with itself, and collects pairs of features.
class PairSearch {
 public:
  PairSearch(const MovingSurface& first, const MovingSurface& second,
             std::vector<NearFeatures>& pairs)
      : first_(first), second_(second), pairs_(pairs), is_within_(&first == &second) {}

  /// Every two triangles of one surface once.
  void descend_within(int i) {
    const SurfaceTree::Node& node = first_.tree->nodes()[at(i)];
    if (node.is_leaf()) return meet_leaves(node, node);
    const int left = i + 1, right = first_.tree->nodes()[at(left)].next;
    descend_within(left);
    descend_within(right);
    descend(left, right);
  }

  void descend(int i, int j) {
    const WayBox &one = first_.nodes[at(i)], &other = second_.nodes[at(j)];
    if (!overlap(one, other)) return;
    const SurfaceTree::Node& a = first_.tree->nodes()[at(i)];
    const SurfaceTree::Node& b = second_.tree->nodes()[at(j)];
    if (a.is_leaf() && b.is_leaf()) return meet_leaves(a, b);
    if (!a.is_leaf() && (b.is_leaf() || squared_size(one) >= squared_size(other))) {
      descend(i + 1, j);
      descend(first_.tree->nodes()[at(i + 1)].next, j);
    } else {
      descend(i, j + 1);
      descend(i, second_.tree->nodes()[at(j + 1)].next);
    }
  }

 private:
  static double squared_size(const WayBox& box) {
    return dot(box.high - box.low, box.high - box.low);
  }

  void meet_leaves(const SurfaceTree::Node& a, const SurfaceTree::Node& b) {
    const bool is_same = is_within_ && a.first == b.first;
    for (int s = a.first; s < a.end; ++s) {
      for (int t = is_same ? s + 1 : b.first; t < b.end; ++t) {
        const int one = first_.tree->order()[at(s)], other = second_.tree->order()[at(t)];
        if (overlap(first_.triangles[at(one)], second_.triangles[at(other)])) meet(one, other);
      }
    }
  }

  void meet(int one, int other) {
    const MeshTopology& a = first_.tree->topology();
    const MeshTopology& b = second_.tree->topology();
    const SurfaceTree::Owned& of_one = first_.tree->owned_by(one);
    const SurfaceTree::Owned& of_other = second_.tree->owned_by(other);
    for (const int v : of_one.vertices()) {
      if (!overlap(first_.vertices[at(v)], second_.triangles[at(other)])) continue;
      if (is_within_ && has(b.triangles()[at(other)], v)) continue;
      pairs_.push_back({{FeatureKind::vertex, v}, {FeatureKind::triangle, other}});
    }
    for (const int v : of_other.vertices()) {
      if (!overlap(first_.triangles[at(one)], second_.vertices[at(v)])) continue;
      if (is_within_ && has(a.triangles()[at(one)], v)) continue;
      pairs_.push_back({{FeatureKind::triangle, one}, {FeatureKind::vertex, v}});
    }
    for (const int e : of_one.edges()) {
      const WayBox around = edge_box(*first_.tree, first_, e);
      if (!overlap(around, second_.triangles[at(other)])) continue;
      for (const int f : of_other.edges()) {
        if (!overlap(around, edge_box(*second_.tree, second_, f))) continue;
        if (is_within_ && share_a_vertex(a.edges()[at(e)], a.edges()[at(f)])) continue;
        pairs_.push_back({{FeatureKind::edge, e}, {FeatureKind::edge, f}});
      }
    }
  }

  static bool has(const Triangle& triangle, int vertex) {
    return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
  }
  static bool share_a_vertex(const std::array<int, 2>& one, const std::array<int, 2>& other) {
    return one[0] == other[0] || one[0] == other[1] || one[1] == other[0] || one[1] == other[1];
  }

  const MovingSurface& first_;
  const MovingSurface& second_;
  std::vector<NearFeatures>& pairs_;
  const bool is_within_;
};

/// Of all ways along a direction, m.
std::pair<double, double> extent(const VertexArray& from, const VertexArray& to, Vec4d direction) {
  const VertexReader start(from), end(to);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int v = 0; v < from.size(); ++v) {
    const double before = dot(direction, start[v]), after = dot(direction, end[v]);
    low = std::min({low, before, after});
    high = std::max({high, before, after});
  }
  return {low, high};
}

/// The plane between two boxes, across one of their faces, that keeps them furthest apart while
/// they move.
class WidestGap {
 public:
  WidestGap(const SurfaceTree& first, const VertexArray& first_from, const VertexArray& first_to,
            const SurfaceTree& second, const VertexArray& second_from,
            const VertexArray& second_to) {
    const auto try_all = [&](const SurfaceTree& tree, const VertexArray& from) {
      const VertexReader x(from);
      for (const int t : tree.face_directions()) {
        const auto& [a, b, c] = tree.topology().triangles()[at(t)];
        const Vec4d across = cross(x[b] - x[a], x[c] - x[a]);
        const Vec4d direction = across / std::sqrt(dot(across, across));
        const auto [low, high] = extent(first_from, first_to, direction);
        const auto [other_low, other_high] = extent(second_from, second_to, direction);
        take_if_wider(direction, low, other_high);
        take_if_wider(-direction, -high, -other_low);
      }
    };
    try_all(first, first_from);
    try_all(second, second_from);
  }

  double width = -std::numeric_limits<double>::infinity();  // m
  Vec4d normal{};                                           // from the second to the first
  double low_of_first = 0.0;                                // m, along the normal
  double high_of_second = 0.0;

 private:
  void take_if_wider(Vec4d direction, double low, double high) {
    if (!(low - high > width)) return;
    width = low - high;
    normal = direction;
    low_of_first = low;
    high_of_second = high;
  }
};

/// Of two boxes: only what lies near the plane between them that keeps them furthest apart.
class BoxPairSearch {
 public:
  BoxPairSearch(const MovingSurface& first, const MovingSurface& second,
                std::vector<NearFeatures>& pairs)
      : first_(first), second_(second), pairs_(pairs) {}

  void find() {
    if (!overlap(first_.nodes.front(), second_.nodes.front())) return;
    const WidestGap gap(*first_.tree, first_.start, first_.end, *second_.tree, second_.start,
                        second_.end);
    const double margin = first_.margin + second_.margin;
    if (gap.width > margin) return;
    const Features of_first = beyond(first_, gap.normal, gap.high_of_second + margin);
    const Features of_second = beyond(second_, -gap.normal, margin - gap.low_of_first);
    find_pairs(of_first, of_second);
  }

 private:
  static constexpr std::size_t most = 12;
  template <class Item>
  struct List {
    std::array<Item, most> items;
    std::size_t count = 0;

    void push_back(const Item& item) { items[count++] = item; }
    auto begin() const { return items.begin(); }
    auto end() const { return items.begin() + count; }
  };
  struct Near {
    int index = 0;
    WayBox box;
  };
  struct Features {
    List<Near> vertices, edges, triangles;
  };

  /// The features of which a part gets below `height` along a direction.
  static Features beyond(const MovingSurface& surface, Vec4d direction, double height) {
    const SurfaceTree& tree = *surface.tree;
    const VertexReader start(surface.start), end(surface.end);
    std::array<bool, most> is_below{};
    Features found;
    for (int v = 0; v < surface.start.size(); ++v) {
      is_below[at(v)] = std::min(dot(direction, start[v]), dot(direction, end[v])) <= height;
      if (is_below[at(v)]) found.vertices.push_back({v, surface.vertices[at(v)]});
    }
    const auto& edges = tree.topology().edges();
    for (int e = 0; e < static_cast<int>(edges.size()); ++e) {
      if (tree.is_flat(e) || !(is_below[at(edges[at(e)][0])] || is_below[at(edges[at(e)][1])])) {
        continue;
      }
      found.edges.push_back({e, edge_box(tree, surface, e)});
    }
    const auto& triangles = tree.topology().triangles();
    for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
      const auto& [a, b, c] = triangles[at(t)];
      if (is_below[at(a)] || is_below[at(b)] || is_below[at(c)]) {
        found.triangles.push_back({t, surface.triangles[at(t)]});
      }
    }
    return found;
  }

  void find_pairs(const Features& a, const Features& b) {
    pair_up(a.vertices, FeatureKind::vertex, b.triangles, FeatureKind::triangle);
    pair_up(a.triangles, FeatureKind::triangle, b.vertices, FeatureKind::vertex);
    pair_up(a.edges, FeatureKind::edge, b.edges, FeatureKind::edge);
  }

  void pair_up(const List<Near>& a, FeatureKind of_a, const List<Near>& b, FeatureKind of_b) {
    for (const Near& one : a) {
      for (const Near& other : b) {
        if (overlap(one.box, other.box)) pairs_.push_back({{of_a, one.index}, {of_b, other.index}});
      }
    }
  }

  const MovingSurface& first_;
  const MovingSurface& second_;
  std::vector<NearFeatures>& pairs_;
};

}  // namespace

void refit(MovingSurface& surface, double margin) {
  surface.margin = margin;
  fit(surface, margin, surface);
}

void fit(const MovingSurface& surface, double margin, WayBoxes& boxes) {
  const SurfaceTree& tree = *surface.tree;
  const VertexReader start(surface.start), end(surface.end);
  boxes.vertices.resize(at(surface.start.size()));
  for (int v = 0; v < surface.start.size(); ++v) {
    boxes.vertices[at(v)] = {min(start[v], end[v]) - margin, max(start[v], end[v]) + margin};
  }
  const auto& triangles = tree.topology().triangles();
  boxes.triangles.resize(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    WayBox& box = boxes.triangles[t] = WayBox{};
    for (const int v : triangles[t]) box.include(boxes.vertices[at(v)]);
  }
  boxes.nodes.resize(tree.nodes().size());
  for (std::size_t i = tree.nodes().size(); i-- > 0;) {
    const SurfaceTree::Node& node = tree.nodes()[i];
    WayBox& box = boxes.nodes[i] = WayBox{};
    for (int t = node.first; t < node.end; ++t) {
      box.include(boxes.triangles[at(tree.order()[at(t)])]);
    }
    if (node.is_leaf()) continue;
    box.include(boxes.nodes[i + 1]);
    box.include(boxes.nodes[at(tree.nodes()[i + 1].next)]);
  }
}

void find_near_features(const MovingSurface& first, const MovingSurface& second,
                        std::vector<NearFeatures>& pairs) {
  if (first.tree->is_box() && second.tree->is_box()) {
    BoxPairSearch(first, second, pairs).find();
  } else {
    PairSearch(first, second, pairs).descend(0, 0);
  }
}

void find_near_features(const MovingSurface& surface, std::vector<NearFeatures>& pairs) {
  PairSearch(surface, surface, pairs).descend_within(0);
}

Vec3 direction_apart(const MovingSurface& first, const MovingSurface& second, Moment moment) {
  const VertexArray& a = moment == Moment::start ? first.start : first.end;
  const VertexArray& b = moment == Moment::start ? second.start : second.end;
  return to_vec3(WidestGap(*first.tree, a, a, *second.tree, b, b).normal);
}

}  // namespace pneuma::sim

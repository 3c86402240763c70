#include "assets/surface.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

namespace pneuma::assets {
namespace {

using sim::at;

/// Sets of numbers that grow together.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int root(int i) {
    while (parent_[at(i)] != i) i = parent_[at(i)] = parent_[at(parent_[at(i)])];
    return i;
  }

  void join(int a, int b) {
    const int root_a = root(a), root_b = root(b);
    parent_[at(std::max(root_a, root_b))] = std::min(root_a, root_b);
  }

 private:
  std::vector<int> parent_;
};

int corner_of(const std::vector<Triangle>& triangles, int triangle, int vertex) {
  const Triangle& corners = triangles[at(triangle)];
  const auto found = std::find(corners.begin(), corners.end(), vertex);
  return 3 * triangle + static_cast<int>(found - corners.begin());
}

/// Whether the triangle runs through the edge from its lower to its higher vertex.
bool runs_forward(const Triangle& triangle, const Edge& edge) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (triangle[i] == edge.vertices[0]) return triangle[(i + 1) % 3] == edge.vertices[1];
  }
  return false;
}

}  // namespace

std::vector<Edge> edges_of(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<std::array<int, 2>, int>> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(triangles[t][i], triangles[t][(i + 1) % 3]);
      sides.push_back({{low, high}, static_cast<int>(t)});
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<Edge> edges;
  for (const auto& [vertices, triangle] : sides) {
    if (edges.empty() || edges.back().vertices != vertices) edges.push_back({vertices, {}});
    edges.back().triangles.push_back(triangle);
  }
  return edges;
}

std::vector<int> components_of(const std::vector<Triangle>& triangles, int vertex_count) {
  UnionFind vertices(at(vertex_count));
  for (const Triangle& triangle : triangles) {
    vertices.join(triangle[0], triangle[1]);
    vertices.join(triangle[0], triangle[2]);
  }
  std::vector<int> number(at(vertex_count), -1);  // of each root
  int count = 0;
  std::vector<int> components;
  components.reserve(triangles.size());
  for (const Triangle& triangle : triangles) {
    int& component = number[at(vertices.root(triangle[0]))];
    if (component < 0) component = count++;
    components.push_back(component);
  }
  return components;
}

std::vector<int> vertices_of_several_fans(const std::vector<Triangle>& triangles,
                                          const std::vector<Edge>& edges, int vertex_count) {
  UnionFind corners(3 * triangles.size());
  std::vector<char> two_sided(at(vertex_count), 1);
  for (const Edge& edge : edges) {
    for (const int vertex : edge.vertices) {
      if (edge.triangles.size() > 2) two_sided[at(vertex)] = 0;
      for (const int triangle : edge.triangles) {
        corners.join(corner_of(triangles, edge.triangles.front(), vertex),
                     corner_of(triangles, triangle, vertex));
      }
    }
  }
  std::vector<int> fan(at(vertex_count), -1);
  std::set<int> found;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int vertex = triangles[at(t)][at(i)];
      const int root = corners.root(3 * t + i);
      if (fan[at(vertex)] < 0) fan[at(vertex)] = root;
      if (fan[at(vertex)] != root && two_sided[at(vertex)]) found.insert(vertex);
    }
  }
  return {found.begin(), found.end()};
}

Orientation orient(const std::vector<Triangle>& triangles, const std::vector<Edge>& edges) {
  struct Neighbour {
    int triangle;
    bool agrees;  // as both are now
  };
  std::vector<std::vector<Neighbour>> neighbours(triangles.size());
  for (const Edge& edge : edges) {
    const int a = edge.triangles[0], b = edge.triangles[1];
    const bool agrees =
        runs_forward(triangles[at(a)], edge) != runs_forward(triangles[at(b)], edge);
    neighbours[at(a)].push_back({b, agrees});
    neighbours[at(b)].push_back({a, agrees});
  }
  constexpr char unknown = 2;
  Orientation result{std::vector<char>(triangles.size(), unknown), {}};
  std::vector<int> open;
  for (std::size_t start = 0; start < triangles.size(); ++start) {
    if (result.turned[start] != unknown) continue;
    result.turned[start] = 0;
    open.push_back(static_cast<int>(start));
    while (!open.empty()) {
      const int t = open.back();
      open.pop_back();
      for (const Neighbour& neighbour : neighbours[at(t)]) {
        char& turned = result.turned[at(neighbour.triangle)];
        if (turned != unknown) continue;
        turned = neighbour.agrees ? result.turned[at(t)] : !result.turned[at(t)];
        open.push_back(neighbour.triangle);
      }
    }
  }
  for (const Edge& edge : edges) {
    const int a = edge.triangles[0], b = edge.triangles[1];
    const bool forward_a = runs_forward(triangles[at(a)], edge) != (result.turned[at(a)] != 0);
    const bool forward_b = runs_forward(triangles[at(b)], edge) != (result.turned[at(b)] != 0);
    if (forward_a == forward_b) result.impossible.push_back(edge);
  }
  return result;
}

}  // namespace pneuma::assets

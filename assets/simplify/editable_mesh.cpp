#include "assets/simplify/editable_mesh.h"

#include <algorithm>
#include <iterator>

namespace pneuma::assets {
namespace {

using sim::at;
using sim::Triangle;

bool has(const Triangle& triangle, int vertex) {
  return std::find(triangle.begin(), triangle.end(), vertex) != triangle.end();
}

bool runs(const Triangle& triangle, int from, int to) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (triangle[i] == from && triangle[(i + 1) % 3] == to) return true;
  }
  return false;
}

int third(const Triangle& triangle, int a, int b) {
  return triangle[0] + triangle[1] + triangle[2] - a - b;
}

Triangle replaced(Triangle triangle, int from, int to) {
  std::replace(triangle.begin(), triangle.end(), from, to);
  return triangle;
}

}  // namespace

EditableMesh::EditableMesh(sim::TriangleMesh mesh)
    : mesh_(std::move(mesh)), around_(mesh_.vertices.size()) {
  for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t) {
    for (const int v : triangle(t)) around_[at(v)].push_back(t);
  }
}

std::vector<int> EditableMesh::neighbours(int vertex) const {
  std::vector<int> result;
  for (const int t : triangles_at(vertex)) {
    for (const int v : triangle(t)) {
      if (v != vertex) result.push_back(v);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::vector<std::array<int, 2>> EditableMesh::edges() const {
  std::vector<std::array<int, 2>> result;
  for (int v = 0; v < vertex_count(); ++v) {
    for (const int other : neighbours(v)) {
      if (v < other) result.push_back({v, other});
    }
  }
  return result;
}

std::vector<int> EditableMesh::triangles_with(int a, int b) const {
  std::vector<int> result;
  std::copy_if(triangles_at(a).begin(), triangles_at(a).end(), std::back_inserter(result),
               [&](int t) { return has(triangle(t), b); });
  return result;
}

std::array<int, 2> EditableMesh::sides(int a, int b) const {
  const std::vector<int> both = triangles_with(a, b);
  if (runs(triangle(both[0]), a, b)) return {both[0], both[1]};
  return {both[1], both[0]};
}

std::array<int, 2> EditableMesh::opposite(int a, int b) const {
  const auto [left, right] = sides(a, b);
  return {third(triangle(left), a, b), third(triangle(right), a, b)};
}

int EditableMesh::split(int a, int b, const Vec3& place) {
  const int middle = vertex_count();
  mesh_.vertices.push_back(place);
  around_.emplace_back();
  for (const int t : sides(a, b)) {
    const Triangle whole = triangle(t);
    detach(t);
    attach(t, replaced(whole, b, middle));
    mesh_.triangles.emplace_back();
    attach(static_cast<int>(mesh_.triangles.size()) - 1, replaced(whole, a, middle));
  }
  return middle;
}

bool EditableMesh::can_collapse(int a, int b) const {
  // The link condition: the ends have no neighbours in common but the two opposite vertices.
  const std::vector<int> near_a = neighbours(a);
  const std::vector<int> near_b = neighbours(b);
  std::vector<int> common;
  std::set_intersection(near_a.begin(), near_a.end(), near_b.begin(), near_b.end(),
                        std::back_inserter(common));
  if (common.size() != 2) return false;
  if (valence(a) + valence(b) - 4 < 4) return false;
  return std::all_of(common.begin(), common.end(), [this](int v) { return valence(v) > 4; });
}

void EditableMesh::collapse(int a, int b, const Vec3& place) {
  for (const int t : sides(a, b)) detach(t);
  for (const int t : std::vector<int>(triangles_at(b))) {
    const Triangle old = triangle(t);
    detach(t);
    attach(t, replaced(old, b, a));
  }
  position(a) = place;
}

void EditableMesh::flip(int a, int b) {
  const auto [left, right] = sides(a, b);
  const auto [c, d] = opposite(a, b);
  detach(left);
  detach(right);
  attach(left, {a, d, c});
  attach(right, {d, b, c});
}

sim::TriangleMesh EditableMesh::compact() const {
  sim::TriangleMesh result;
  std::vector<int> renumbered(around_.size(), -1);
  for (int v = 0; v < vertex_count(); ++v) {
    if (triangles_at(v).empty()) continue;
    renumbered[at(v)] = static_cast<int>(result.vertices.size());
    result.vertices.push_back(position(v));
  }
  for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t) {
    const auto [a, b, c] = triangle(t);
    if (a == b) continue;  // detached
    result.triangles.push_back({renumbered[at(a)], renumbered[at(b)], renumbered[at(c)]});
  }
  return result;
}

void EditableMesh::detach(int triangle_index) {
  for (const int v : triangle(triangle_index)) std::erase(around_[at(v)], triangle_index);
  mesh_.triangles[at(triangle_index)] = {};
}

void EditableMesh::attach(int triangle_index, const Triangle& corners) {
  mesh_.triangles[at(triangle_index)] = corners;
  for (const int v : corners) around_[at(v)].push_back(triangle_index);
}

}  // namespace pneuma::assets

#include "assets/part_from_itself.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "assets/self_touching.h"

namespace pneuma::assets {
namespace {

using sim::at;

constexpr int most_smoothings = 20;
constexpr std::size_t most_pairs = 10'000;  // of triangles that touch
constexpr double most_vertices = 0.05;      // of all; 50 in any case
constexpr double furthest = 0.02;           // of the diagonal: that a vertex moves

/// Half way to the middle of their neighbours.
void smooth(sim::TriangleMesh& mesh, const std::set<int>& vertices) {
  std::map<int, std::set<int>> neighbours;
  for (const Triangle& triangle : mesh.triangles) {
    for (const int v : triangle) {
      if (vertices.contains(v)) neighbours[v].insert(triangle.begin(), triangle.end());
    }
  }
  std::map<int, Vec3> moved;
  for (auto& [vertex, around] : neighbours) {
    around.erase(vertex);
    Vec3 sum = Vec3::Zero();
    for (const int v : around) sum += mesh.vertices[at(v)];
    moved[vertex] = 0.5 * (mesh.vertices[at(vertex)] + sum / static_cast<double>(around.size()));
  }
  for (const auto& [vertex, place] : moved) mesh.vertices[at(vertex)] = place;
}

}  // namespace

std::vector<std::string> part_from_itself(NumberedMesh& mesh) {
  const std::vector<Vec3> before = mesh.mesh.vertices;
  const auto most = std::max(50.0, most_vertices * static_cast<double>(before.size()));
  const double distance = furthest * diagonal_of(before);
  const auto is_far = [&](int v) {
    return (mesh.mesh.vertices[at(v)] - before[at(v)]).norm() > distance;
  };
  std::set<int> moved;
  for (int pass = 0; pass < most_smoothings; ++pass) {
    const SelfTouching touching = find_self_touching(mesh.mesh, most_pairs);
    if (!touching.complete) break;
    if (touching.count == 0) {
      const std::vector<int> all(moved.begin(), moved.end());
      if (all.empty()) return {};
      return {fmt::format("{} moved to part the surface from itself{}",
                          counted(all.size(), "vertex", "vertices"), vertex_places(mesh, all))};
    }
    for (const auto& pair : touching.first) {
      for (const int t : pair) {
        moved.insert(mesh.mesh.triangles[at(t)].begin(), mesh.mesh.triangles[at(t)].end());
      }
    }
    if (static_cast<double>(moved.size()) > most) break;
    smooth(mesh.mesh, moved);
    if (std::ranges::any_of(moved, is_far)) break;
  }
  mesh.mesh.vertices = before;
  return {};
}

}  // namespace pneuma::assets

#include "assets/repair_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "assets/fill_holes.h"
#include "assets/weld.h"

namespace pneuma::assets {
namespace {

using sim::at;

/// Of the diagonal: vertices on the two sides of a crack are nearer to each other. A third of the
/// edge length of 100,000 vertices spread evenly.
constexpr double crack = 1e-3;
/// Of the way to the middle of its neighbours: where one vertex becomes several.
constexpr double split_by = 0.1;
constexpr int most_passes = 20;

template <class Keep>
void keep_triangles(NumberedMesh& mesh, const Keep& keep) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
    if (!keep(t)) continue;
    mesh.mesh.triangles[count] = mesh.mesh.triangles[t];
    mesh.triangle_number[count] = mesh.triangle_number[t];
    ++count;
  }
  mesh.mesh.triangles.resize(count);
  mesh.triangle_number.resize(count);
}

bool is_proper(const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  return a != b && b != c && c != a;
}

/// Vertices at edges with one triangle, none of whose edges is so short that its ends could be
/// taken for the sides of a crack.
std::vector<int> rim_vertices(const sim::TriangleMesh& mesh, double distance) {
  std::set<int> rim, crowded;
  for (const Edge& edge : edges_of(mesh.triangles)) {
    const auto& [a, b] = edge.vertices;
    if (edge.triangles.size() == 1) rim.insert({a, b});
    if ((mesh.vertices[at(a)] - mesh.vertices[at(b)]).norm() < 2.0 * distance) {
      crowded.insert({a, b});
    }
  }
  std::vector<int> result;
  std::ranges::set_difference(rim, crowded, std::back_inserter(result));
  return result;
}

void close_cracks(NumberedMesh& mesh, std::vector<std::string>& done) {
  const double distance = crack * diagonal_of(mesh.mesh.vertices);
  const std::vector<int> rim = rim_vertices(mesh.mesh, distance);
  if (rim.empty()) return;
  std::vector<Vec3> places;
  for (const int v : rim) places.push_back(mesh.mesh.vertices[at(v)]);
  const Weld welded = weld(places, distance);
  std::vector<int> first(welded.vertices.size(), -1), new_index(mesh.mesh.vertices.size()), moved;
  std::iota(new_index.begin(), new_index.end(), 0);
  for (std::size_t i = 0; i < rim.size(); ++i) {
    int& kept = first[at(welded.new_index[i])];
    if (kept < 0) kept = rim[i];
    new_index[at(rim[i])] = kept;
    if (kept != rim[i]) moved.push_back(rim[i]);
  }
  if (moved.empty()) return;
  for (Triangle& triangle : mesh.mesh.triangles) {
    for (int& v : triangle) v = new_index[at(v)];
  }
  keep_triangles(mesh, [&](std::size_t t) { return is_proper(mesh.mesh.triangles[t]); });
  done.push_back(fmt::format("{} at cracks of up to {:.2g} welded to others{}",
                             counted(moved.size(), "vertex", "vertices"), distance,
                             vertex_places(mesh, moved)));
}

/// Triangles with an edge of their own and one that three or more have.
void drop_fins(NumberedMesh& mesh, std::vector<std::string>& done) {
  std::vector<std::string> places;
  std::size_t count = 0;
  for (int pass = 0; pass < most_passes; ++pass) {
    std::vector<char> is_loose(mesh.mesh.triangles.size(), 0), is_crowded(is_loose);
    for (const Edge& edge : edges_of(mesh.mesh.triangles)) {
      for (const int t : edge.triangles) {
        if (edge.triangles.size() == 1) is_loose[at(t)] = 1;
        if (edge.triangles.size() > 2) is_crowded[at(t)] = 1;
      }
    }
    const std::size_t before = mesh.mesh.triangles.size();
    for (std::size_t t = 0; t < before; ++t) {
      if (is_loose[t] == 0 || is_crowded[t] == 0) continue;
      if (places.size() < most_places) places.push_back(triangle_place(mesh, static_cast<int>(t)));
      ++count;
    }
    keep_triangles(mesh, [&](std::size_t t) { return is_loose[t] == 0 || is_crowded[t] == 0; });
    if (mesh.mesh.triangles.size() == before) break;
  }
  if (count == 0) return;
  done.push_back(fmt::format("{} that stood out of the surface dropped{}",
                             counted(count, "triangle", "triangles"),
                             first_places(count, [&](std::size_t i) { return places[i]; })));
}

/// The triangles around a vertex, those of one fan with one number.
std::vector<int> fans_of(const std::vector<Triangle>& triangles, const std::vector<int>& around,
                         int vertex) {
  std::vector<int> fan(around.size());
  std::iota(fan.begin(), fan.end(), 0);
  const auto share_an_edge = [&](const Triangle& one, const Triangle& other) {
    return std::ranges::any_of(
        one, [&](int v) { return v != vertex && std::ranges::find(other, v) != other.end(); });
  };
  for (std::size_t i = 0; i < around.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!share_an_edge(triangles[at(around[i])], triangles[at(around[j])])) continue;
      const int from = fan[i], to = fan[j];
      std::ranges::replace(fan, std::max(from, to), std::min(from, to));
    }
  }
  return fan;
}

/// A new vertex for one fan, a little towards the middle of its triangles.
void give_own_vertex(NumberedMesh& mesh, const std::vector<int>& fan, int vertex) {
  const Vec3 place = mesh.mesh.vertices[at(vertex)];
  Vec3 sum = Vec3::Zero();
  const int added = static_cast<int>(mesh.mesh.vertices.size());
  for (const int t : fan) {
    for (int& v : mesh.mesh.triangles[at(t)]) {
      if (v == vertex) {
        v = added;
      } else {
        sum += mesh.mesh.vertices[at(v)] - place;
      }
    }
  }
  mesh.mesh.vertices.push_back(place + split_by * sum / (2.0 * static_cast<double>(fan.size())));
  mesh.vertex_number.push_back(mesh.vertex_number[at(vertex)]);
}

void split_fans(NumberedMesh& mesh, std::vector<std::string>& done) {
  const std::vector<int> pinched =
      vertices_of_several_fans(mesh.mesh.triangles, edges_of(mesh.mesh.triangles),
                               static_cast<int>(mesh.mesh.vertices.size()));
  if (pinched.empty()) return;
  std::map<int, std::vector<int>> around;
  for (const int v : pinched) around[v];
  for (std::size_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
    for (const int v : mesh.mesh.triangles[t]) {
      if (const auto found = around.find(v); found != around.end()) {
        found->second.push_back(static_cast<int>(t));
      }
    }
  }
  for (const auto& [vertex, triangles] : around) {
    const std::vector<int> fan = fans_of(mesh.mesh.triangles, triangles, vertex);
    std::map<int, std::vector<int>> members;
    for (std::size_t i = 0; i < fan.size(); ++i) members[fan[i]].push_back(triangles[i]);
    for (auto next = std::next(members.begin()); next != members.end(); ++next) {
      give_own_vertex(mesh, next->second, vertex);
    }
  }
  done.push_back(fmt::format("{} at which fans of triangles meet split{}",
                             counted(pinched.size(), "vertex", "vertices"),
                             vertex_places(mesh, pinched)));
}

double side(const sim::TriangleMesh& mesh, const Triangle& triangle, std::size_t i) {
  return (mesh.vertices[at(triangle[i])] - mesh.vertices[at(triangle[(i + 1) % 3])]).norm();
}

std::size_t longest_side(const sim::TriangleMesh& mesh, const Triangle& triangle) {
  std::size_t longest = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (side(mesh, triangle, i) > side(mesh, triangle, longest)) longest = i;
  }
  return longest;
}

bool is_flat(const sim::TriangleMesh& mesh, const Triangle& triangle, double min_height) {
  const Vec3& a = mesh.vertices[at(triangle[0])];
  const Vec3 ab = mesh.vertices[at(triangle[1])] - a, ac = mesh.vertices[at(triangle[2])] - a;
  return !(ab.cross(ac).norm() > min_height * side(mesh, triangle, longest_side(mesh, triangle)));
}

/// Turns the longest edge of each flat triangle that has one neighbour there, which no other flat
/// triangle has changed in this pass. Returns the places of those.
std::vector<std::string> turn_longest_edges(NumberedMesh& mesh, double min_height) {
  auto& triangles = mesh.mesh.triangles;
  std::map<std::array<int, 2>, std::vector<int>> at_edge;
  for (const Edge& edge : edges_of(triangles)) at_edge[edge.vertices] = edge.triangles;
  std::vector<char> is_changed(triangles.size(), 0);
  std::vector<std::string> places;
  const auto key = [](int v, int w) { return std::array{std::min(v, w), std::max(v, w)}; };
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (is_changed[t] != 0 || !is_flat(mesh.mesh, triangles[t], min_height)) continue;
    const std::size_t i = longest_side(mesh.mesh, triangles[t]);
    const int a = triangles[t][i], b = triangles[t][(i + 1) % 3], c = triangles[t][(i + 2) % 3];
    const std::vector<int>& both = at_edge.at(key(a, b));
    if (both.size() != 2) continue;
    const int other = both[0] == static_cast<int>(t) ? both[1] : both[0];
    if (is_changed[at(other)] != 0) continue;
    const auto d =
        std::ranges::find_if(triangles[at(other)], [&](int v) { return v != a && v != b; });
    const int opposite = *d;
    // Two triangles of the same corners have no other edge to turn to.
    if (opposite == c || at_edge.contains(key(c, opposite))) continue;
    places.push_back(triangle_place(mesh, static_cast<int>(t)));
    triangles[t] = {a, opposite, c};
    triangles[at(other)] = {opposite, b, c};
    is_changed[t] = is_changed[at(other)] = 1;
  }
  return places;
}

void take_out_flat_triangles(NumberedMesh& mesh, double min_height,
                             std::vector<std::string>& done) {
  std::vector<std::string> places;
  for (int pass = 0; pass < most_passes; ++pass) {
    const std::vector<std::string> turned = turn_longest_edges(mesh, min_height);
    if (turned.empty()) break;
    places.insert(places.end(), turned.begin(), turned.end());
  }
  if (places.empty()) return;
  done.push_back(
      fmt::format("{} without area taken out{}", counted(places.size(), "triangle", "triangles"),
                  first_places(places.size(), [&](std::size_t i) { return places[i]; })));
}

bool is_crowded(const NumberedMesh& mesh) {
  return std::ranges::any_of(edges_of(mesh.mesh.triangles),
                             [](const Edge& edge) { return edge.triangles.size() > 2; });
}

}  // namespace

std::vector<std::string> repair_mesh(NumberedMesh& mesh, double min_height) {
  std::vector<std::string> done;
  close_cracks(mesh, done);
  drop_fins(mesh, done);
  if (is_crowded(mesh)) return done;
  split_fans(mesh, done);
  for (std::string& filled : fill_holes(mesh)) done.push_back(std::move(filled));
  take_out_flat_triangles(mesh, min_height, done);
  return done;
}

}  // namespace pneuma::assets

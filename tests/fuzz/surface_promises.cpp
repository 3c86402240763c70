#include "tests/fuzz/surface_promises.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace pneuma::fuzz {
namespace {

using sim::at;
using sim::Triangle;
using sim::TriangleMesh;
using Wide = long double;
using WideVec3 = Eigen::Matrix<Wide, 3, 1>;

std::string bad_number(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return "no triangles";
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!mesh.vertices[v].allFinite()) return fmt::format("vertex {} is not finite", v);
  }
  std::set<int> used;
  for (const Triangle& triangle : mesh.triangles) {
    for (const int v : triangle) {
      if (v < 0 || at(v) >= mesh.vertices.size()) return fmt::format("index {} out of range", v);
      used.insert(v);
    }
  }
  if (used.size() != mesh.vertices.size()) return "a vertex without triangles";
  return {};
}

/// Each edge once in each direction: closed, manifold at edges, and all triangles turned alike.
std::string bad_edge(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> directed;
  for (const auto& [a, b, c] : mesh.triangles) {
    if (a == b || b == c || c == a) return "a triangle with a vertex twice";
    for (const auto& edge : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) ++directed[edge];
  }
  for (const auto& [edge, count] : directed) {
    const auto& [a, b] = edge;
    if (count != 1) return fmt::format("edge {}-{} is there {} times", a, b, count);
    if (directed.count({b, a}) == 0) return fmt::format("edge {}-{} has no way back", a, b);
  }
  return {};
}

/// The sides across from a vertex make one ring.
std::string bad_vertex(const TriangleMesh& mesh) {
  std::vector<std::map<int, int>> next(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    next[at(a)][b] = c;
    next[at(b)][c] = a;
    next[at(c)][a] = b;
  }
  for (std::size_t v = 0; v < next.size(); ++v) {
    const int start = next[v].begin()->first;
    std::size_t steps = 0;
    int at_vertex = start;
    do {
      at_vertex = next[v].at(at_vertex);
      ++steps;
    } while (at_vertex != start && steps <= next[v].size());
    if (steps != next[v].size()) return fmt::format("vertex {} has several fans", v);
  }
  return {};
}

std::string several_pieces(const TriangleMesh& mesh) {
  std::set<int> reached = {mesh.triangles[0][0]};
  for (std::size_t before = 0; before != reached.size();) {
    before = reached.size();
    for (const Triangle& triangle : mesh.triangles) {
      const auto is_reached = [&](int v) { return reached.count(v) > 0; };
      if (std::any_of(triangle.begin(), triangle.end(), is_reached)) {
        reached.insert(triangle.begin(), triangle.end());
      }
    }
  }
  return reached.size() == mesh.vertices.size() ? std::string() : "several pieces";
}

WideVec3 wide(const TriangleMesh& mesh, int v) { return mesh.vertices[at(v)].cast<Wide>(); }

/// Of one closed surface that does not meet itself the volume is positive if and only if it faces
/// outwards: the theorem of Gauss.
std::string bad_volume(const TriangleMesh& mesh) {
  const WideVec3 origin = wide(mesh, 0);
  Wide volume = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const WideVec3 p = wide(mesh, a) - origin, q = wide(mesh, b) - origin;
    volume += p.dot(q.cross(wide(mesh, c) - origin)) / 6;
  }
  if (volume > 0) return {};
  return fmt::format("a volume of {}", static_cast<double>(volume));
}

Wide extent(const TriangleMesh& mesh) {
  WideVec3 low = wide(mesh, 0), high = low;
  for (int v = 1; v < static_cast<int>(mesh.vertices.size()); ++v) {
    low = low.cwiseMin(wide(mesh, v));
    high = high.cwiseMax(wide(mesh, v));
  }
  return (high - low).norm();
}

/// Whether the segment p q runs through the inside of a triangle without any doubt: its ends well
/// apart from the plane, on both sides, the point between them well within.
bool pierces(const WideVec3& p, const WideVec3& q, const WideVec3& a, const WideVec3& b,
             const WideVec3& c, Wide clearance) {
  const WideVec3 area = (b - a).cross(c - a);
  const Wide doubled = area.norm();
  if (!(doubled > 0)) return false;
  const Wide above = area.dot(p - a) / doubled, below = area.dot(q - a) / doubled;
  if (std::min(above, below) > -clearance || std::max(above, below) < clearance) return false;
  const WideVec3 x = p + (q - p) * (above / (above - below));
  const auto share = [&](const WideVec3& from, const WideVec3& to) {
    return area.dot((to - from).cross(x - from)) / (doubled * doubled);
  };
  constexpr Wide margin = 1e-4L;
  return share(a, b) > margin && share(b, c) > margin && share(c, a) > margin;
}

std::string crossing(const TriangleMesh& mesh) {
  const Wide clearance = 1e-5L * extent(mesh);
  const int count = static_cast<int>(mesh.triangles.size());
  for (int t = 0; t < count; ++t) {
    const auto& [a, b, c] = mesh.triangles[at(t)];
    for (int s = 0; s < count; ++s) {
      for (std::size_t i = 0; i < 3; ++i) {
        const int p = mesh.triangles[at(s)][i], q = mesh.triangles[at(s)][(i + 1) % 3];
        if (p == a || p == b || p == c || q == a || q == b || q == c) continue;
        if (pierces(wide(mesh, p), wide(mesh, q), wide(mesh, a), wide(mesh, b), wide(mesh, c),
                    clearance)) {
          return fmt::format("edge {}-{} pierces triangle {}", p, q, t);
        }
      }
    }
  }
  return {};
}

}  // namespace

std::string broken_promise(const TriangleMesh& mesh) {
  for (const auto& check :
       {bad_number, bad_edge, bad_vertex, several_pieces, bad_volume, crossing}) {
    if (std::string fault = check(mesh); !fault.empty()) return fault;
  }
  return {};
}

}  // namespace pneuma::fuzz

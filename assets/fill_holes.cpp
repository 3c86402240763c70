#include "assets/fill_holes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "sim/mesh/measure.h"

namespace pneuma::assets {
namespace {

using sim::at;

constexpr std::size_t most_edges = 500;  // the time grows with their cube: 0.1 s
constexpr double most_area = 0.25;       // of the surface that the hole is in

struct Hole {
  std::vector<int> rim;  // vertices, one after the other
  int triangle = 0;      // at its first edge
};

/// Each vertex of a rim has two of its edges.
std::vector<Hole> holes_of(const std::vector<Edge>& edges) {
  std::map<int, std::vector<const Edge*>> at_vertex;
  for (const Edge& edge : edges) {
    if (edge.triangles.size() != 1) continue;
    for (const int v : edge.vertices) at_vertex[v].push_back(&edge);
  }
  std::set<const Edge*> seen;
  std::vector<Hole> holes;
  for (const auto& [start, around] : at_vertex) {
    const Edge* edge = around.front();
    if (seen.contains(edge)) continue;
    Hole hole{{}, edge->triangles.front()};
    for (int v = start; seen.insert(edge).second;) {
      hole.rim.push_back(v);
      v = edge->vertices[0] == v ? edge->vertices[1] : edge->vertices[0];
      const auto& both = at_vertex.at(v);
      edge = both.front() == edge ? both.back() : both.front();
    }
    holes.push_back(std::move(hole));
  }
  return holes;
}

double area_of(const sim::TriangleMesh& mesh, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  return sim::area_vector(mesh.vertices[at(a)], mesh.vertices[at(b)], mesh.vertices[at(c)]).norm();
}

/// Triangulates a rim by the least area of all.
class LeastArea {
 public:
  LeastArea(const sim::TriangleMesh& mesh, const std::set<std::pair<int, int>>& edges,
            const std::vector<int>& rim)
      : mesh_(mesh),
        edges_(edges),
        rim_(rim),
        area_(rim.size() * rim.size(), 0.0),
        middle_(area_.size(), 0) {}

  /// Infinite if every way would use an edge of the surface once more.
  double area() {
    const std::size_t n = rim_.size();
    for (std::size_t span = 2; span < n; ++span) {
      for (std::size_t i = 0; i + span < n; ++i) find_middle(i, i + span);
    }
    return area_[n - 1];
  }

  /// Of a finite area.
  std::vector<Triangle> triangles() const {
    std::vector<Triangle> result;
    collect(0, rim_.size() - 1, result);
    return result;
  }

 private:
  /// The best triangle on the chord from i to j, whose two other sides are chords found before.
  void find_middle(std::size_t i, std::size_t j) {
    double& best = area_[index(i, j)];
    best = std::numeric_limits<double>::infinity();
    const bool is_rim = i == 0 && j + 1 == rim_.size();
    if (!is_rim && edges_.contains(std::minmax(rim_[i], rim_[j]))) return;
    for (std::size_t k = i + 1; k < j; ++k) {
      const double area =
          area_[index(i, k)] + area_[index(k, j)] + area_of(mesh_, {rim_[i], rim_[k], rim_[j]});
      if (!(area < best)) continue;
      best = area;
      middle_[index(i, j)] = k;
    }
  }

  void collect(std::size_t i, std::size_t j, std::vector<Triangle>& result) const {
    if (j < i + 2) return;
    const std::size_t k = middle_[index(i, j)];
    result.push_back({rim_[i], rim_[k], rim_[j]});
    collect(i, k, result);
    collect(k, j, result);
  }

  std::size_t index(std::size_t i, std::size_t j) const { return i * rim_.size() + j; }

  const sim::TriangleMesh& mesh_;
  const std::set<std::pair<int, int>>& edges_;
  const std::vector<int>& rim_;
  std::vector<double> area_;  // least of the rim's part from i to j
  std::vector<std::size_t> middle_;
};

/// Of all that hangs together.
std::vector<double> areas(const sim::TriangleMesh& mesh, const std::vector<int>& component) {
  std::vector<double> result(at(*std::ranges::max_element(component)) + 1, 0.0);
  for (std::size_t t = 0; t < component.size(); ++t) {
    result[at(component[t])] += area_of(mesh, mesh.triangles[t]);
  }
  return result;
}

}  // namespace

std::vector<std::string> fill_holes(NumberedMesh& mesh) {
  const std::vector<Edge> edges = edges_of(mesh.mesh.triangles);
  std::vector<Hole> holes = holes_of(edges);
  if (holes.empty()) return {};
  const std::vector<int> component =
      components_of(mesh.mesh.triangles, static_cast<int>(mesh.mesh.vertices.size()));
  const std::vector<double> whole = areas(mesh.mesh, component);
  std::set<std::pair<int, int>> known;
  for (const Edge& edge : edges) known.insert({edge.vertices[0], edge.vertices[1]});

  std::size_t added = 0;
  std::vector<int> filled;  // a vertex of each
  for (const Hole& hole : holes) {
    if (hole.rim.size() > most_edges) continue;
    LeastArea least(mesh.mesh, known, hole.rim);
    if (!(least.area() <= most_area * whole[at(component[at(hole.triangle)])])) continue;
    const std::vector<Triangle> triangles = least.triangles();
    filled.push_back(hole.rim.front());
    added += triangles.size();
    for (const Triangle& triangle : triangles) {
      mesh.mesh.triangles.push_back(triangle);
      mesh.triangle_number.push_back(mesh.triangle_number[at(hole.triangle)]);
      for (std::size_t i = 0; i < 3; ++i) {
        known.insert(std::minmax(triangle[i], triangle[(i + 1) % 3]));
      }
    }
  }
  if (filled.empty()) return {};
  return {fmt::format(
      "{} filled by {}{}", counted(filled.size(), "hole", "holes"),
      counted(added, "triangle", "triangles"),
      first_places(filled.size(), [&](std::size_t i) { return vertex_place(mesh, filled[i]); }))};
}

std::string why_holes_are_left(const std::vector<Edge>& edges) {
  const std::vector<Hole> holes = holes_of(edges);
  std::vector<std::size_t> rims;
  for (const Hole& hole : holes) rims.push_back(hole.rim.size());
  std::ranges::sort(rims, std::greater());
  const bool has_more = rims.size() > most_places;
  if (has_more) rims.resize(most_places);
  return fmt::format(
      "{} too large to be closed by a repair, with {}{} edges around {}: it closes holes of at "
      "most {} edges by triangles of at most {:g} times the surface's area",
      holes.size() == 1 ? "1 hole is" : fmt::format("{} holes are", holes.size()),
      fmt::join(rims, ", "), has_more ? ", ..." : "", holes.size() == 1 ? "it" : "them", most_edges,
      most_area);
}

}  // namespace pneuma::assets

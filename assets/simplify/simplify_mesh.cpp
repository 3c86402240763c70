#include "assets/simplify/simplify_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <queue>
#include <tuple>
#include <vector>

#include "assets/simplify/guarded_mesh.h"
#include "assets/simplify/quadric.h"

namespace pneuma::assets {
namespace {

using sim::at;
using sim::Triangle;

/// Of the squared distances from a vertex to what it stands for, beside those from the planes of
/// the triangles there: more makes triangles more even, less follows the surface better.
constexpr double evenness = 0.02;

/// What a collapse may leave behind.
struct CollapseLimits {
  double shape;      // of a triangle: its area over that of an equilateral one of the same sides
  double agreement;  // cosine of the angle that a triangle turns by
  int valence;       // the stiffest vertices are those of many springs
};

/// Edges that the first refuse are left to the next.
constexpr CollapseLimits all_limits[] = {{0.5, 0.5, 8}, {0.2, 0.2, 10}, {1e-3, 0.0, 1'000}};

/// Twice the area, outwards.
Vec3 area_vector(const Vec3& a, const Vec3& b, const Vec3& c) { return (b - a).cross(c - a); }

Vec3 area_vector(const std::array<Vec3, 3>& corners) {
  return area_vector(corners[0], corners[1], corners[2]);
}

/// Of equilateral triangles, two for each vertex.
double edge_length(const sim::TriangleMesh& mesh, double vertices) {
  double area = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    area +=
        0.5 * area_vector(mesh.vertices[at(a)], mesh.vertices[at(b)], mesh.vertices[at(c)]).norm();
  }
  return std::sqrt(area / (0.5 * std::numbers::sqrt3 * vertices));
}

/// An edge to shrink.
struct Candidate {
  double error;
  int a, b;
  int age;  // of both ends: younger than they are, it is out of date

  /// A queue gives its greatest first.
  bool operator<(const Candidate& other) const {
    return std::tie(error, a, b) > std::tie(other.error, other.a, other.b);
  }
};

class Simplifier {
 public:
  Simplifier(const sim::TriangleMesh& mesh, int most_vertices)
      // On the way edges get longer: what is found of a search is best half way.
      : guarded_(mesh, edge_length(mesh, std::sqrt(static_cast<double>(mesh.vertices.size()) *
                                                   most_vertices))),
        count_(static_cast<int>(mesh.vertices.size())),
        most_vertices_(most_vertices),
        age_(mesh.vertices.size(), 0),
        quadrics_(mesh.vertices.size()) {
    for (int v = 0; v < count_; ++v) {
      for (const int t : mesh_.triangles_at(v)) add_triangle(v, mesh_.triangle(t));
    }
  }

  sim::TriangleMesh simplify() {
    for (const CollapseLimits& limits : all_limits) {
      limits_ = limits;
      for (int before = count_ + 1; count_ > most_vertices_ && count_ < before;) {
        before = count_;
        collapse_edges();
      }
    }
    return guarded_.result();
  }

 private:
  const Vec3& position(int vertex) const { return mesh_.position(vertex); }

  /// To what the vertex stands for.
  void add_triangle(int vertex, const Triangle& triangle) {
    const auto& [a, b, c] = triangle;
    const Vec3 twice_area = area_vector(position(a), position(b), position(c));
    const double length = twice_area.norm();
    if (!(length > 0.0)) return;
    const Vec3 normal = twice_area / length;
    const double third_of_area = length / 6.0;
    quadrics_[at(vertex)].add_plane(normal, normal.dot(position(a)), third_of_area);
    quadrics_[at(vertex)].add_point(position(vertex), evenness * third_of_area);
  }

  Quadric quadric_of(int a, int b) const {
    Quadric quadric = quadrics_[at(a)];
    quadric += quadrics_[at(b)];
    return quadric;
  }

  void collapse_edges() {
    queue_ = {};
    for (const auto& [a, b] : mesh_.edges()) suggest(a, b);
    while (count_ > most_vertices_ && !queue_.empty()) {
      const auto [error, a, b, age] = queue_.top();
      queue_.pop();
      const bool are_left = mesh_.valence(a) > 0 && mesh_.valence(b) > 0;
      if (are_left && age == age_[at(a)] + age_[at(b)]) collapse(a, b);
    }
  }

  void suggest(int a, int b) {
    const Quadric quadric = quadric_of(a, b);
    const auto place = place_for(a, b, quadric);
    if (!place) return;
    queue_.push({quadric.value(*place), std::min(a, b), std::max(a, b), age_[at(a)] + age_[at(b)]});
  }

  void collapse(int a, int b) {
    const Quadric quadric = quadric_of(a, b);
    const auto place = place_for(a, b, quadric);  // what is around may have changed since
    if (!place || !may_collapse(a, b, *place)) return;
    guarded_.collapse(a, b, *place);
    quadrics_[at(a)] = quadric;
    ++age_[at(a)];
    --count_;
    for (const int v : mesh_.neighbours(a)) suggest(a, v);
  }

  /// Of the least error, where the volume stays as it is: with triangles p q from the new vertex x
  /// to the ring about the edge six times their volumes, x . sum of p x q, are what those of the
  /// old triangles are. All of it as seen from a.
  std::optional<Vec3> place_for(int a, int b, const Quadric& quadric) const {
    const Vec3& origin = position(a);
    Vec3 ring = Vec3::Zero();
    double volume = 0.0;
    for (const int vertex : {a, b}) {
      for (const int t : mesh_.triangles_at(vertex)) {
        const auto [p, q] = others(mesh_.triangle(t), vertex);
        const bool is_at_edge = p == a || p == b || q == a || q == b;
        if (is_at_edge && vertex == b) continue;  // it was there with a
        const Vec3 cross = (position(p) - origin).cross(position(q) - origin);
        volume += cross.dot(position(vertex) - origin);
        if (!is_at_edge) ring += cross;
      }
    }
    const Vec3 place = quadric.minimum_on(ring, volume + ring.dot(origin));
    const double farthest = 2.0 * (position(b) - origin).norm();
    const bool is_near = GuardedMesh::is_on_grid(place) && (place - origin).norm() <= farthest;
    return is_near ? std::optional(GuardedMesh::on_grid(place)) : std::nullopt;
  }

  /// The two vertices of a triangle that follow its third.
  static std::array<int, 2> others(const Triangle& triangle, int vertex) {
    const auto [a, b, c] = triangle;
    if (a == vertex) return {b, c};
    return b == vertex ? std::array{c, a} : std::array{a, b};
  }

  bool may_collapse(int a, int b, const Vec3& place) {
    if (!mesh_.can_collapse(a, b)) return false;
    if (mesh_.valence(a) + mesh_.valence(b) - 4 > limits_.valence) return false;
    before_.clear();
    now_.clear();
    for (const int vertex : {a, b}) {
      for (const int t : mesh_.triangles_at(vertex)) {
        const Triangle& triangle = mesh_.triangle(t);
        const auto [p, q] = others(triangle, vertex);
        const bool is_at_edge = p == a || p == b || q == a || q == b;
        if (!is_at_edge || vertex == a) before_.push_back(t);
        if (is_at_edge) continue;
        if (!is_well_shaped({place, position(p), position(q)}, triangle)) return false;
        now_.push_back({a, p, q});
      }
    }
    return guarded_.stays_apart(before_, now_, a, place);
  }

  bool is_well_shaped(const std::array<Vec3, 3>& now, const Triangle& before) const {
    const auto& [a, b, c] = before;
    const Vec3 old_area = area_vector(position(a), position(b), position(c));
    const Vec3 area = area_vector(now);
    const double size = area.norm();
    const double squares = (now[1] - now[0]).squaredNorm() + (now[2] - now[1]).squaredNorm() +
                           (now[0] - now[2]).squaredNorm();
    return 2.0 * std::numbers::sqrt3 * size > limits_.shape * squares &&
           area.dot(old_area) > limits_.agreement * size * old_area.norm();
  }

  GuardedMesh guarded_;
  const EditableMesh& mesh_ = guarded_.mesh();
  CollapseLimits limits_ = all_limits[0];
  int count_;
  int most_vertices_;
  std::vector<int> age_;  // of the vertices: how often they took another one's place
  std::vector<Quadric> quadrics_;
  std::priority_queue<Candidate> queue_;
  std::vector<int> before_;  // of may_collapse, kept for their memory
  std::vector<Triangle> now_;
};

}  // namespace

sim::TriangleMesh simplify_mesh(const sim::TriangleMesh& mesh, int most_vertices) {
  if (mesh.vertices.size() <= at(most_vertices)) return mesh;
  return Simplifier(mesh, most_vertices).simplify();
}

}  // namespace pneuma::assets

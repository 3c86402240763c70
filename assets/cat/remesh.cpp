#include "assets/cat/remesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace pneuma::assets {
namespace {

using sim::at;
using sim::Triangle;

constexpr int rounds = 40;            // that change lengths, until the spacing has settled
constexpr int polishing_rounds = 40;  // that flip for angles and slide only

/// From Botsch & Kobbelt: an edge at either bound is as far from the wanted length after the change
/// as before it.
constexpr double longest = 4.0 / 3.0;
constexpr double shortest = 4.0 / 5.0;

/// Cosine of the max. angle by which a change may turn a triangle.
constexpr double least_agreement = 0.7;

class Remesher {
 public:
  Remesher(const sim::TriangleMesh& rough, const RemeshTarget& target)
      : mesh_(rough), target_(target) {
    for (int v = 0; v < mesh_.vertex_count(); ++v) {
      mesh_.position(v) = target_.project(mesh_.position(v));
    }
  }

  sim::TriangleMesh run() {
    for (int i = 0; i < rounds; ++i) {
      split_long_edges();
      collapse_short_edges();
      flip_edges([this](int a, int b, int c, int d) { return evens_valences(a, b, c, d); });
      slide_vertices();
    }
    for (int i = 0; i < polishing_rounds; ++i) {
      flip_edges([this](int a, int b, int c, int d) { return widens_angles(a, b, c, d); });
      slide_vertices();
    }
    return mesh_.compact();
  }

 private:
  /// Length of an edge as a fraction of what is wanted there.
  double relative_length(const Vec3& a, const Vec3& b) const {
    return (b - a).norm() / target_.edge_length(0.5 * (a + b));
  }

  double relative_length(int a, int b) const {
    return relative_length(mesh_.position(a), mesh_.position(b));
  }

  Vec3 middle(int a, int b) const {
    return target_.project(0.5 * (mesh_.position(a) + mesh_.position(b)));
  }

  /// Twice the area vector.
  Vec3 normal(const Triangle& triangle) const {
    const Vec3& a = mesh_.position(triangle[0]);
    return (mesh_.position(triangle[1]) - a).cross(mesh_.position(triangle[2]) - a);
  }

  void split_long_edges() {
    for (const auto& [a, b] : mesh_.edges()) {
      if (relative_length(a, b) > longest) mesh_.split(a, b, middle(a, b));
    }
  }

  void collapse_short_edges() {
    for (const auto& [a, b] : mesh_.edges()) {
      if (mesh_.valence(a) == 0 || mesh_.valence(b) == 0 || !mesh_.has_edge(a, b)) continue;
      if (relative_length(a, b) >= shortest || !mesh_.can_collapse(a, b)) continue;
      const Vec3 place = middle(a, b);
      if (moves_well(a, b, place) && moves_well(b, a, place)) mesh_.collapse(a, b, place);
    }
  }

  /// Whether `vertex`, when the edge to `other` shrinks to `place`, leaves no edge too long and
  /// turns no triangle over.
  bool moves_well(int vertex, int other, const Vec3& place) const {
    for (const int v : mesh_.neighbours(vertex)) {
      if (v != other && relative_length(place, mesh_.position(v)) > longest) return false;
    }
    for (const int t : mesh_.triangles_at(vertex)) {
      const Triangle& triangle = mesh_.triangle(t);
      if (std::find(triangle.begin(), triangle.end(), other) != triangle.end()) continue;
      std::array<Vec3, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = triangle[i] == vertex ? place : mesh_.position(triangle[i]);
      }
      const Vec3 moved = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      if (!agree(moved, normal(triangle))) return false;
    }
    return true;
  }

  static bool agree(const Vec3& a, const Vec3& b) {
    return a.dot(b) > least_agreement * std::sqrt(a.squaredNorm() * b.squaredNorm());
  }

  template <class Wanted>
  void flip_edges(const Wanted& wanted) {
    for (const auto& [a, b] : mesh_.edges()) {
      if (!mesh_.has_edge(a, b)) continue;
      const auto [c, d] = mesh_.opposite(a, b);
      if (mesh_.valence(a) <= 4 || mesh_.valence(b) <= 4 || mesh_.has_edge(c, d)) continue;
      if (folds(a, b, c, d) || !wanted(a, b, c, d)) continue;
      mesh_.flip(a, b);
    }
  }

  /// Whether the surface would no longer follow what it follows now if c-d took the place of a-b.
  bool folds(int a, int b, int c, int d) const {
    const Vec3 mean = normal({a, b, c}) + normal({b, a, d});
    return !agree(normal({a, d, c}), mean) || !agree(normal({d, b, c}), mean);
  }

  /// Whether the flip brings the valences of the four vertices nearer to six.
  bool evens_valences(int a, int b, int c, int d) const {
    const auto squared_excess = [this](int v, int change) {
      const int excess = mesh_.valence(v) + change - 6;
      return excess * excess;
    };
    const int before =
        squared_excess(a, 0) + squared_excess(b, 0) + squared_excess(c, 0) + squared_excess(d, 0);
    const int after =
        squared_excess(a, -1) + squared_excess(b, -1) + squared_excess(c, 1) + squared_excess(d, 1);
    return after < before;
  }

  /// Whether the flip makes the smallest of the six angles greater.
  bool widens_angles(int a, int b, int c, int d) const {
    const double before = std::max(sharpest({a, b, c}), sharpest({b, a, d}));
    const double after = std::max(sharpest({a, d, c}), sharpest({d, b, c}));
    return after < before;
  }

  /// Cosine of a triangle's smallest angle.
  double sharpest(const Triangle& triangle) const {
    double max_cosine = -1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& corner = mesh_.position(triangle[i]);
      const Vec3 one = mesh_.position(triangle[(i + 1) % 3]) - corner;
      const Vec3 other = mesh_.position(triangle[(i + 2) % 3]) - corner;
      max_cosine =
          std::max(max_cosine, one.dot(other) / std::sqrt(one.squaredNorm() * other.squaredNorm()));
    }
    return max_cosine;
  }

  /// Moves every vertex towards the centre of its triangles, along the surface only. Triangles
  /// weigh by their area in units of what is wanted there, so that the spacing follows.
  void slide_vertices() {
    std::vector<Vec3> moved;
    for (int v = 0; v < mesh_.vertex_count(); ++v) moved.push_back(slid(v));
    for (int v = 0; v < mesh_.vertex_count(); ++v) mesh_.position(v) = moved[at(v)];
  }

  Vec3 slid(int v) const {
    const Vec3& here = mesh_.position(v);
    if (mesh_.valence(v) == 0) return here;
    Vec3 normal_sum = Vec3::Zero();
    Vec3 weighted = Vec3::Zero();
    double weights = 0.0;
    for (const int t : mesh_.triangles_at(v)) {
      const auto& [a, b, c] = mesh_.triangle(t);
      const Vec3 centre = (mesh_.position(a) + mesh_.position(b) + mesh_.position(c)) / 3.0;
      const Vec3 area = normal(mesh_.triangle(t));
      const double length = target_.edge_length(centre);
      const double weight = area.norm() / (length * length);
      normal_sum += area;
      weighted += weight * centre;
      weights += weight;
    }
    const Vec3 up = normal_sum / normal_sum.norm();
    const Vec3 step = weighted / weights - here;
    return target_.project(here + step - step.dot(up) * up);
  }

  EditableMesh mesh_;
  const RemeshTarget& target_;
};

}  // namespace

sim::TriangleMesh remesh(const sim::TriangleMesh& rough, const RemeshTarget& target) {
  return Remesher(rough, target).run();
}

}  // namespace pneuma::assets

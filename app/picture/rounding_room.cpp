#include "app/picture/rounding_room.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "render/geometry/rounding.h"
#include "sim/collision/feature_tests.h"
#include "sim/mesh/measure.h"

namespace pneuma::app {
namespace {

using sim::Bounds;
using sim::Corners;

constexpr std::size_t most_rounded_triangles = 2'000;

bool is_rounded(const render::Mesh& mesh) {
  return !mesh.normals.empty() && mesh.shape->triangles.size() <= most_rounded_triangles;
}

Bounds bounds_of(const render::Mesh& mesh) {
  Bounds bounds;
  for (const auto& position : mesh.positions) bounds.include(position.cast<double>());
  return bounds;
}

/// m, at most, of each triangle; 0 for those that stay flat.
std::vector<double> bulges_of(const render::Mesh& mesh) {
  std::vector<double> bulges(mesh.shape->triangles.size(), 0.0);
  if (!is_rounded(mesh)) return bulges;
  for (std::size_t i = 0; i < bulges.size(); ++i) {
    bulges[i] = render::bulge_bound(mesh.shape->triangles[i], mesh.positions, mesh.normals);
  }
  return bulges;
}

/// The triangles of a mesh.
struct Faces {
  std::vector<Corners> corners;
  std::vector<Bounds> bounds;
};

Faces faces_of(const render::Mesh& mesh) {
  Faces faces;
  for (const render::Triangle& triangle : mesh.shape->triangles) {
    Corners corners;
    Bounds bounds;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = mesh.positions[triangle[i]].cast<double>();
      bounds.include(corners[i]);
    }
    faces.corners.push_back(corners);
    faces.bounds.push_back(bounds);
  }
  return faces;
}

/// Squared; 0 when they overlap. No points within are nearer.
double squared_distance(const Bounds& a, const Bounds& b) {
  return (a.low - b.high).cwiseMax(b.low - a.high).cwiseMax(0.0).squaredNorm();
}

bool within(const Bounds& a, const Bounds& b, double reach) {
  return squared_distance(a, b) < reach * reach;
}

std::vector<std::size_t> faces_near(const Faces& faces, const Bounds& other, double reach) {
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < faces.bounds.size(); ++i) {
    if (within(faces.bounds[i], other, reach)) near.push_back(i);
  }
  return near;
}

/// The bodies of a picture, and the room that they leave each other.
class Rooms {
 public:
  explicit Rooms(const std::vector<render::Mesh>& meshes) : meshes_(meshes) {
    for (const render::Mesh& mesh : meshes) {
      bounds_.push_back(bounds_of(mesh));
      bulges_.push_back(bulges_of(mesh));
      most_bulges_.push_back(bulges_.back().empty() ? 0.0 : std::ranges::max(bulges_.back()));
      rooms_.emplace_back(bulges_.back().size(), std::numeric_limits<float>::infinity());
    }
    faces_.resize(meshes.size());
  }

  void reduce(std::size_t first, std::size_t second) {
    const double reach = 2.0 * std::max(most_bulges_[first], most_bulges_[second]);
    if (!within(bounds_[first], bounds_[second], reach)) return;
    const std::vector<std::size_t> others = faces_near(faces(second), bounds_[first], reach);
    for (const std::size_t i : faces_near(faces(first), bounds_[second], reach)) {
      for (const std::size_t j : others) reduce(first, i, second, j);
    }
  }

  std::vector<float> take(std::size_t mesh) { return std::move(rooms_[mesh]); }

 private:
  const Faces& faces(std::size_t mesh) {
    if (faces_[mesh].bounds.empty()) faces_[mesh] = faces_of(meshes_[mesh]);
    return faces_[mesh];
  }

  /// Of triangles i and j. Further away than twice the room that both have, nothing is decided.
  void reduce(std::size_t first, std::size_t i, std::size_t second, std::size_t j) {
    float& first_room = rooms_[first][i];
    float& second_room = rooms_[second][j];
    const double needed = 2.0 * std::max(std::min<double>(bulges_[first][i], first_room),
                                         std::min<double>(bulges_[second][j], second_room));
    if (!within(faces_[first].bounds[i], faces_[second].bounds[j], needed)) return;
    const auto near =
        sim::test_triangle_triangle(faces_[first].corners[i], faces_[second].corners[j], needed);
    if (!near) return;
    const auto half = static_cast<float>(0.5 * near->distance);
    first_room = std::min(first_room, half);
    second_room = std::min(second_room, half);
  }

  const std::vector<render::Mesh>& meshes_;
  std::vector<Bounds> bounds_;
  std::vector<std::vector<double>> bulges_;  // m
  std::vector<double> most_bulges_;          // m
  std::vector<std::vector<float>> rooms_;    // m
  std::vector<Faces> faces_;                 // empty until another body is near
};

}  // namespace

void set_rounding_room(std::vector<render::Mesh>& meshes) {
  Rooms rooms(meshes);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    for (std::size_t j = i + 1; j < meshes.size(); ++j) {
      if (is_rounded(meshes[i]) || is_rounded(meshes[j])) rooms.reduce(i, j);
    }
  }
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (is_rounded(meshes[i])) meshes[i].room = rooms.take(i);
  }
}

}  // namespace pneuma::app

#include "render/geometry/rounding.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pneuma::render {
namespace {

/// Of the shortest edge of a triangle. Of a sphere of 58 vertices no bulge is that high; long
/// triangles along what is straight, such as a cone's, would be bent.
constexpr float most_of_edge = 0.4f;

float shortest_edge(const Triangle& triangle, std::span<const Vec3f> positions) {
  float shortest = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3f edge = positions[triangle[i]] - positions[triangle[(i + 1) % 3]];
    shortest = std::min(shortest, edge.norm());
  }
  return shortest;
}

}  // namespace

float bulge_bound(const Triangle& triangle, std::span<const Vec3f> positions,
                  std::span<const Vec3f> normals) {
  float height = 0.0f;
  for (const std::uint32_t i : triangle) {
    for (const std::uint32_t j : triangle) {
      height = std::max(height, std::abs((positions[i] - positions[j]).dot(normals[i])));
    }
  }
  return height / 3.0f;
}

Vec3f rounded_position(std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                       std::span<const float> share, const SurfacePoint& point) {
  const auto& [corners, weights] = point;
  Vec3f p = Vec3f::Zero();
  float shared = 0.0f;
  for (std::size_t i = 0; i < 3; ++i) {
    p += weights[i] * positions[corners[i]];
    shared += weights[i] * share[corners[i]];
  }
  Vec3f bulge = Vec3f::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3f& n = normals[corners[i]];
    bulge += weights[i] * (positions[corners[i]] - p).dot(n) * n;
  }
  return p + 0.5f * shared * bulge;
}

std::vector<float> bulge_shares(const std::vector<Triangle>& triangles,
                                std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                                std::span<const float> room) {
  std::vector<float> share(positions.size(), 1.0f);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const float bound = bulge_bound(triangles[t], positions, normals);
    const float most = std::min(room[t], most_of_edge * shortest_edge(triangles[t], positions));
    if (bound <= most) continue;
    for (const std::uint32_t v : triangles[t]) share[v] = std::min(share[v], most / bound);
  }
  return share;
}

}  // namespace pneuma::render

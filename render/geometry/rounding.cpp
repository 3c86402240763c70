#include "render/geometry/rounding.h"

#include <algorithm>
#include <cmath>

namespace pneuma::render {
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
    if (bound <= room[t]) continue;
    for (const std::uint32_t v : triangles[t]) share[v] = std::min(share[v], room[t] / bound);
  }
  return share;
}

}  // namespace pneuma::render

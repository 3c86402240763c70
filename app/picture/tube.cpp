#include "app/picture/tube.h"

#include <cmath>

namespace pneuma::app {

using render::Vec3f;

LineAxes::LineAxes(const Vec3f& way) : along(Vec3f::UnitX()) {
  const float length = way.norm();
  if (length > 0.0f) along = way / length;
  const Vec3f off = std::abs(along.z()) < 0.9f ? Vec3f::UnitZ() : Vec3f::UnitX();
  across = off.cross(along).normalized();
  other = along.cross(across);
}

void add_tube(std::uint32_t first, int rings, int sides, render::MeshShape& shape) {
  const auto vertex = [&](int ring, int side) {
    return first + static_cast<std::uint32_t>(ring * sides + side % sides);
  };
  for (int ring = 0; ring + 1 < rings; ++ring) {
    for (int side = 0; side < sides; ++side) {
      const auto a = vertex(ring, side), b = vertex(ring, side + 1);
      const auto c = vertex(ring + 1, side + 1), d = vertex(ring + 1, side);
      shape.triangles.push_back({a, b, c});
      shape.triangles.push_back({a, c, d});
    }
  }
}

}  // namespace pneuma::app

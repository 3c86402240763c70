#include "app/picture/edge_bars.h"

#include <cmath>
#include <utility>

namespace pneuma::app {
namespace {

using render::Vec3f;

constexpr std::uint32_t corners = 4;  // around a bar
constexpr float enough_off = 0.9f;    // of its length along z: across is not taken from z

/// Of a bar without ends, whose first vertex has this number.
void add_sides(std::uint32_t first, render::MeshShape& shape) {
  for (std::uint32_t side = 0; side < corners; ++side) {
    const std::uint32_t a = first + side, b = first + (side + 1) % corners;
    shape.triangles.push_back({a, b, b + corners});
    shape.triangles.push_back({a, b + corners, a + corners});
  }
}

/// From the middle of a bar to its corners.
std::array<Vec3f, corners> corners_around(const Vec3f& way, float radius) {
  const float length = way.norm();
  const Vec3f along = length > 0.0f ? Vec3f(way / length) : Vec3f(Vec3f::UnitX());
  const Vec3f off = std::abs(along.z()) < enough_off ? Vec3f::UnitZ() : Vec3f::UnitX();
  const Vec3f across = radius * off.cross(along).normalized();
  const Vec3f other = along.cross(across);
  return {across, other, -across, -other};
}

}  // namespace

EdgeBars::EdgeBars(Edges edges, const std::vector<render::Colour>& colours, float radius)
    : edges_(std::move(edges)), radius_(radius) {
  auto shape = std::make_shared<render::MeshShape>();
  for (const auto& edge : edges_) {
    add_sides(static_cast<std::uint32_t>(shape->colours.size()), *shape);
    for (const std::uint32_t end : edge) {
      shape->colours.insert(shape->colours.end(), corners, colours[end]);
    }
  }
  shape_ = std::move(shape);
}

render::Mesh EdgeBars::mesh(const std::vector<Vec3f>& positions) const {
  render::Mesh bars;
  bars.shape = shape_;
  for (const auto& edge : edges_) {
    const auto around = corners_around(positions[edge[1]] - positions[edge[0]], radius_);
    for (const std::uint32_t end : edge) {
      for (const Vec3f& corner : around) bars.positions.push_back(positions[end] + corner);
    }
  }
  return bars;
}

}  // namespace pneuma::app

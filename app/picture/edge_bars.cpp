#include "app/picture/edge_bars.h"

#include <utility>

#include "app/picture/tube.h"

namespace pneuma::app {
namespace {

using render::Vec3f;

constexpr int corners = 4;  // around a bar

}  // namespace

EdgeBars::EdgeBars(Edges edges, const std::vector<render::Colour>& colours, float radius)
    : edges_(std::move(edges)), radius_(radius) {
  auto shape = std::make_shared<render::MeshShape>();
  for (const auto& edge : edges_) {
    add_tube(static_cast<std::uint32_t>(shape->colours.size()), 2, corners, *shape);
    for (const std::uint32_t end : edge) {
      shape->colours.insert(shape->colours.end(), corners, colours[end]);
    }
  }
  shape_ = std::move(shape);
}

render::Mesh EdgeBars::mesh(const std::vector<Vec3f>& positions) const {
  render::Mesh bars;
  bars.shape = shape_;
  bars.takes_light = false;
  for (const auto& edge : edges_) {
    const LineAxes axes(positions[edge[1]] - positions[edge[0]]);
    const Vec3f across = radius_ * axes.across, other = radius_ * axes.other;
    for (const std::uint32_t end : edge) {
      for (const Vec3f& corner : {across, other, Vec3f(-across), Vec3f(-other)}) {
        bars.positions.push_back(positions[end] + corner);
      }
    }
  }
  return bars;
}

}  // namespace pneuma::app

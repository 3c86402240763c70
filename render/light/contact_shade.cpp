#include "render/light/contact_shade.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pneuma::render {
namespace {

/// A corner of a triangle: where it is in the picture, in texels, and its height, m.
struct Corner {
  float x;
  float y;
  float height;
};

class NearnessPicture {
 public:
  NearnessPicture(const GroundPicture& picture, std::vector<float>& nearness)
      : picture_(picture), nearness_(nearness) {
    const auto side = static_cast<std::size_t>(picture.size);
    nearness_.assign(side * side, 0.0f);
  }

  Corner corner(const Vec3f& position) const {
    const Eigen::Vector4f foot(position.x(), position.y(), 0.0f, 1.0f);
    const Eigen::Vector2f at = (picture_.world_to_picture * foot).head<2>();
    const auto side = static_cast<float>(picture_.size);
    return {at.x() * side, at.y() * side, position.z()};
  }

  void add(const std::array<Corner, 3>& corners) {
    for (const Corner& corner : corners) {
      put(static_cast<int>(std::floor(corner.x)), static_cast<int>(std::floor(corner.y)),
          corner.height);
    }
    fill(corners);
    for (std::size_t i = 0; i < 3; ++i) follow_crossing(corners, i);
  }

  bool any() const { return any_; }

 private:
  void put(int column, int row, float height) {
    if (column < 0 || row < 0 || column >= picture_.size || row >= picture_.size) return;
    const float left = 1.0f - std::abs(height) / picture_.reach;
    if (left <= 0.0f) return;
    any_ = true;
    float& value = nearness_[static_cast<std::size_t>(row * picture_.size + column)];
    value = std::max(value, left * left);
  }

  /// All texels whose middles lie in the triangle.
  void fill(const std::array<Corner, 3>& corners) {
    const auto& [a, b, c] = corners;
    const float area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (std::abs(area) < 1e-6f) return;  // seen from the side
    const auto first = [](float low) { return std::max(0, static_cast<int>(std::floor(low))); };
    const auto end = [this](float high) {
      return std::min(picture_.size, static_cast<int>(std::ceil(high)));
    };
    for (int row = first(std::min({a.y, b.y, c.y})); row < end(std::max({a.y, b.y, c.y})); ++row) {
      for (int column = first(std::min({a.x, b.x, c.x})); column < end(std::max({a.x, b.x, c.x}));
           ++column) {
        const float x = static_cast<float>(column) + 0.5f;
        const float y = static_cast<float>(row) + 0.5f;
        const float of_b = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / area;
        const float of_c = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / area;
        if (of_b < 0.0f || of_c < 0.0f || of_b + of_c > 1.0f) continue;
        put(column, row, a.height + of_b * (b.height - a.height) + of_c * (c.height - a.height));
      }
    }
  }

  /// The line on which a triangle goes through the ground, from the edges at a corner that lies
  /// alone on its side: of a steep one fill() finds no texel there.
  void follow_crossing(const std::array<Corner, 3>& corners, std::size_t alone) {
    const Corner& a = corners[alone];
    const Corner &b = corners[(alone + 1) % 3], &c = corners[(alone + 2) % 3];
    const auto is_below = [](const Corner& corner) { return corner.height < 0.0f; };
    if (is_below(b) != is_below(c) || is_below(a) == is_below(b)) return;
    const auto crossing = [&a](const Corner& to) -> Eigen::Vector2f {
      const float part = a.height / (a.height - to.height);
      return {a.x + part * (to.x - a.x), a.y + part * (to.y - a.y)};
    };
    const Eigen::Vector2f from = crossing(b), way = crossing(c) - from;
    const float length = std::min(way.norm(), 4.0f * static_cast<float>(picture_.size));
    const int points = 2 + static_cast<int>(2.0f * length);
    for (int i = 0; i < points; ++i) {
      const Eigen::Vector2f at =
          from + static_cast<float>(i) / static_cast<float>(points - 1) * way;
      put(static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())), 0.0f);
    }
  }

  const GroundPicture& picture_;
  std::vector<float>& nearness_;
  bool any_ = false;
};

}  // namespace

bool measure_nearness(std::span<const SurfaceVertex> vertices, std::span<const Triangle> triangles,
                      const GroundPicture& picture, std::vector<float>& nearness) {
  NearnessPicture result(picture, nearness);
  for (const Triangle& triangle : triangles) {
    const Vec3f& a = vertices[triangle[0]].position;
    const Vec3f& b = vertices[triangle[1]].position;
    const Vec3f& c = vertices[triangle[2]].position;
    if (std::min({a.z(), b.z(), c.z()}) >= picture.reach) continue;
    if (std::max({a.z(), b.z(), c.z()}) <= -picture.reach) continue;
    result.add({result.corner(a), result.corner(b), result.corner(c)});
  }
  return result.any();
}

}  // namespace pneuma::render

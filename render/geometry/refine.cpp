#include "render/geometry/refine.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace pneuma::render {
namespace {

using Weights = std::array<float, 3>;

/// A part of one of the mesh's triangles: its points, and their weights on that triangle.
struct Part {
  std::uint32_t of;
  Triangle points;
  std::array<Weights, 3> weights;
};

class Refiner {
 public:
  Refiner(const std::vector<Triangle>& triangles, std::size_t vertex_count,
          const NeedsHalving& needs_halving)
      : triangles_(triangles), needs_halving_(needs_halving) {
    for (std::uint32_t v = 0; v < vertex_count; ++v) points_.push_back({{v, v, v}, {1, 0, 0}});
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      parts_.push_back({t, triangles[t], {Weights{1, 0, 0}, Weights{0, 1, 0}, Weights{0, 0, 1}}});
    }
  }

  /// Returns whether there was anything to halve.
  bool halve_once() {
    const std::vector<Part> before = std::exchange(parts_, {});
    parts_.reserve(2 * before.size());
    middles_.clear();
    middles_.reserve(2 * before.size());  // a closed surface has 3/2 edges a triangle
    for (const Part& part : before) divide(part);
    return parts_.size() > before.size();
  }

  Refinement result() && {
    Refinement refinement{std::move(points_), {}};
    for (const Part& part : parts_) refinement.triangles.push_back(part.points);
    return refinement;
  }

 private:
  static constexpr std::uint32_t none = ~0u;

  void divide(const Part& part) {
    std::array<std::uint32_t, 3> middles;
    for (std::size_t i = 0; i < 3; ++i) middles[i] = middle(part, i);
    const auto halved = std::count_if(middles.begin(), middles.end(),
                                      [](std::uint32_t point) { return point != none; });
    // The first corner is chosen so that what is halved is: edge 0; edges 0 and 1; all.
    std::size_t first = 0;
    while (halved == 1 && middles[first] == none) ++first;
    while (halved == 2 && middles[(first + 2) % 3] != none) ++first;
    const Corner a = corner(part, first), b = corner(part, first + 1), c = corner(part, first + 2);
    if (halved == 0) return add(part.of, a, b, c);
    const Corner ab = between(a, b, middles[first % 3]);
    if (halved == 1) {
      add(part.of, a, ab, c);
      return add(part.of, ab, b, c);
    }
    const Corner bc = between(b, c, middles[(first + 1) % 3]);
    add(part.of, ab, b, bc);
    if (halved == 2) {
      add(part.of, a, ab, bc);
      return add(part.of, a, bc, c);
    }
    const Corner ca = between(c, a, middles[(first + 2) % 3]);
    add(part.of, a, ab, ca);
    add(part.of, ab, bc, ca);
    add(part.of, ca, bc, c);
  }

  struct Corner {
    std::uint32_t point;
    Weights weights;
  };

  static Corner corner(const Part& part, std::size_t i) {
    return {part.points[i % 3], part.weights[i % 3]};
  }

  static Weights mean(const Weights& a, const Weights& b) {
    return {0.5f * (a[0] + b[0]), 0.5f * (a[1] + b[1]), 0.5f * (a[2] + b[2])};
  }

  static Corner between(const Corner& a, const Corner& b, std::uint32_t point) {
    return {point, mean(a.weights, b.weights)};
  }

  void add(std::uint32_t of, const Corner& a, const Corner& b, const Corner& c) {
    parts_.push_back({of, {a.point, b.point, c.point}, {a.weights, b.weights, c.weights}});
  }

  /// The middle of the edge from corner i to the next, or none where it is left whole.
  std::uint32_t middle(const Part& part, std::size_t i) {
    const Corner a = corner(part, i), b = corner(part, i + 1);
    const auto [low, high] = std::minmax(a.point, b.point);
    const auto [known, is_new] =
        middles_.try_emplace(std::uint64_t{low} << 32 | std::uint64_t{high}, none);
    if (is_new && needs_halving_(points_, low, high)) {
      known->second = static_cast<std::uint32_t>(points_.size());
      points_.push_back({triangles_[part.of], mean(a.weights, b.weights)});
    }
    return known->second;
  }

  const std::vector<Triangle>& triangles_;
  const NeedsHalving& needs_halving_;
  std::vector<SurfacePoint> points_;
  std::vector<Part> parts_;
  std::unordered_map<std::uint64_t, std::uint32_t> middles_;
};

}  // namespace

Refinement refine(const std::vector<Triangle>& triangles, std::size_t vertex_count, int levels,
                  const NeedsHalving& needs_halving) {
  Refiner refiner(triangles, vertex_count, needs_halving);
  for (int level = 0; level < levels && refiner.halve_once(); ++level) {
  }
  return std::move(refiner).result();
}

}  // namespace pneuma::render

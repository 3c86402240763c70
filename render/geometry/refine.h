// A finer triangulation of a mesh's triangles where it is needed, for drawing it rounded.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace pneuma::render {

using Triangle = std::array<std::uint32_t, 3>;

/// A point on a triangle: its three vertices and their weights, which add up to 1.
struct SurfacePoint {
  Triangle corners;
  std::array<float, 3> weights;
};

struct Refinement {
  std::vector<SurfacePoint> points;  // first the vertices, in their order
  std::vector<Triangle> triangles;   // of points
};

/// Whether the edge between two of the points so far has to be halved.
using NeedsHalving =
    std::function<bool(const std::vector<SurfacePoint>& points, std::uint32_t a, std::uint32_t b)>;

/// Halves edges up to `levels` times. An edge is asked about once, and the triangles on both of its
/// sides share the answer and the point, so that the surface stays closed.
Refinement refine(const std::vector<Triangle>& triangles, std::size_t vertex_count, int levels,
                  const NeedsHalving& needs_halving);

}  // namespace pneuma::render

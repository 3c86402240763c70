// Surfaces through the vertices of a coarse mesh that look as round as its shading.
//
// Phong tessellation (Boubekeur and Alexa, 2008): the point p of a triangle with the weights w_i
// moves by  s * sum of w_i ((x_i - p) . n_i) n_i  towards the tangent planes of the vertices x_i
// with the normals n_i. With s = 1/2 an edge becomes the parabola that agrees with the circle
// through its ends in all terms of the second order; the paper's 3/4 bulges further than that.
// Along an edge it depends on its two ends only, so that neighbours stay joined.
#pragma once

#include <span>
#include <vector>

#include "render/frame/frame.h"
#include "render/geometry/refine.h"

namespace pneuma::render {

/// Where a point of the flat triangles moves, with `share` of the bulge at each vertex, 0..1.
Vec3f rounded_position(std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                       std::span<const float> share, const SurfacePoint& point);

/// m. No point of a triangle moves further: h / 3 with h the largest |(x_i - x_j) . n_i|, as the
/// sum of w_i (1 - w_i) is at most 2/3.
float bulge_bound(const Triangle& triangle, std::span<const Vec3f> positions,
                  std::span<const Vec3f> normals);

/// The share at each vertex, such that no triangle bulges by more than its `room` (m), nor by much
/// of its shortest edge: a vertex takes the least of its triangles.
std::vector<float> bulge_shares(const std::vector<Triangle>& triangles,
                                std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                                std::span<const float> room);

}  // namespace pneuma::render

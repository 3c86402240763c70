// A first, uneven mesh of a solid given by a signed distance.
#pragma once

#include <functional>

#include "assets/cat/cat_shape.h"

namespace pneuma::assets {

/// The surface where `distance` is zero, outward oriented, by marching tetrahedra over cubes of
/// side `cell`. Closed and manifold provided that the surface stays inside the box.
sim::TriangleMesh isosurface(const std::function<double(const Vec3&)>& distance, const CatBox& box,
                             double cell);

}  // namespace pneuma::assets

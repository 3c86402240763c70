// Is a point inside a soft body, and where is the nearest way out (section 5.2.2)?
#pragma once

#include <optional>

#include "sim/collision/surface_view.h"
#include "sim/collision/triangle_columns.h"

namespace pneuma::sim {

/// Whether a point lies inside a closed surface: whether a ray along +z crosses it an odd number of
/// times (ERRATA row 17). Wrong at most for points within rounding of the surface: 8 units in the
/// last digit of the largest coordinate.
bool is_inside(const SurfaceView& surface, const Vec3& point);

/// How far above a point inside the body (m, along +z) its surface begins. None for a point
/// outside.
std::optional<double> height_of_exit(const SurfaceView& surface, const Vec3& point);

/// How far inside a body a point is, and through which triangle it gets out soonest.
struct SurfaceExit {
  int triangle = 0;
  Vec3 normal = Vec3::Zero();  // outward unit normal of the triangle
  Vec3 point = Vec3::Zero();   // the nearest point of the surface, m
  double depth = 0.0;          // m from there to the inside point
};

/// None for a point outside (ERRATA row 50). `columns` filled from the surface.
std::optional<SurfaceExit> find_surface_exit(const SurfaceView& surface,
                                             const TriangleColumns& columns, const Vec3& point);

}  // namespace pneuma::sim

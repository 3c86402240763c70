// Predicates of points with integer coordinates, free of rounding.
#pragma once

#include <array>
#include <cstdint>

namespace pneuma::base {

/// Coordinates up to 2^30 in size: a determinant of three differences stays below 2^96.
using GridPoint = std::array<std::int64_t, 3>;
inline constexpr std::int64_t grid_steps = std::int64_t{1} << 30;

/// On which side of the plane a, b, c the point d lies: 1 where the triangle runs clockwise as seen
/// from d, -1 on the other side, 0 on the plane.
int side_of_plane(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d);

/// Whether three points are on one line.
bool on_one_line(const GridPoint& a, const GridPoint& b, const GridPoint& c);

/// Whether the segment p q and the triangle a b c, which has an area, have a point in common, ends
/// and sides included.
bool segment_meets_triangle(const GridPoint& p, const GridPoint& q, const GridPoint& a,
                            const GridPoint& b, const GridPoint& c);

/// Whether the point d, in the plane of the triangle a b c, lies on the same side of a b as c.
bool same_side_of_edge(const GridPoint& a, const GridPoint& b, const GridPoint& c,
                       const GridPoint& d);

}  // namespace pneuma::base

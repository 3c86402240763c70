// Predicates of points with double coordinates, free of rounding.
#pragma once

#include <array>

namespace pneuma::base {

/// A point of space. The predicates are exact where each coordinate is 0 or between 1e-75 and
/// 1e100 in size; a point that is not finite counts as lying on every plane.
using Point = std::array<double, 3>;

/// On which side of the plane a, b, c the point d lies: 1 where the triangle runs clockwise as seen
/// from d, -1 on the other side, 0 on the plane. As base::side_of_plane of grid points.
int side_of_plane(const Point& a, const Point& b, const Point& c, const Point& d);

/// How a segment passes through a triangle.
struct Passage {
  int direction = 0;  // 1 from the side that sees the triangle clockwise, -1 back, 0: not at all
  std::array<bool, 3> meets_side = {};  // a b, b c, c a: the segment's line meets it
  bool in_plane = false;                // both ends lie on the triangle's plane
};

/// Passing is not touching: the ends of p q lie strictly on different sides of the plane a b c, and
/// p q meets the triangle. Where it meets a side or a corner, the triangle counts that p q would
/// meet if it were shifted by (e, e^2, e^3) for a vanishing e > 0. Thus of the triangles about a
/// vertex or at an edge of a closed surface, unless p q lies in the plane of one of them, the
/// directions sum up to 1 or -1 if p q passes through the surface there, to 0 if it only touches
/// it.
Passage find_passage(const Point& p, const Point& q, const Point& a, const Point& b,
                     const Point& c);

}  // namespace pneuma::base

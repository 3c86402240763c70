#include "sim/collision/point_in_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pneuma::sim {

namespace {

// Where the nearest point is on an edge or a vertex, all triangles there are equally near up to
// rounding, relative to the distance. Of those the one that faces the point most squarely is taken.
constexpr double same_distance = 1e-12;

/// Where an edge of the mesh passes through the plane y = const of the point.
struct Passage {
  double x;
  double z;
};

/// Only for an edge with one end on either side. Always computed from the end with the lower index,
/// and with fma, which leaves the compiler no choice of rounding, so that both triangles at the
/// edge get the very same numbers.
Passage passage(const VertexArray& positions, int a, int b, double y) {
  if (a > b) std::swap(a, b);
  const Vec3 from = positions[a];
  const Vec3 to = positions[b];
  const double s = (y - from.y()) / (to.y() - from.y());
  return {std::fma(s, to.x() - from.x(), from.x()), std::fma(s, to.z() - from.z(), from.z())};
}

/// Where, in z, the line through the point along z crosses the triangle, by the slice described
/// below.
std::optional<double> find_crossing(const VertexArray& positions, const Triangle& triangle,
                                    const Vec3& point) {
  const auto& [a, b, c] = triangle;
  const bool a_beyond = positions[a].y() > point.y();
  const bool b_beyond = positions[b].y() > point.y();
  const bool c_beyond = positions[c].y() > point.y();
  if (a_beyond == b_beyond && b_beyond == c_beyond) return {};
  // The corner alone on its side of the plane is joined to the other two by the sliced edges.
  const int lone = b_beyond == c_beyond ? a : (a_beyond == c_beyond ? b : c);
  const int next = lone == a ? b : (lone == b ? c : a);
  const int last = lone == a ? c : (lone == b ? a : b);
  const Passage p = passage(positions, lone, next, point.y());
  const Passage q = passage(positions, lone, last, point.y());
  if ((p.x > point.x()) == (q.x > point.x())) return {};
  const double t = (point.x() - p.x) / (q.x - p.x);
  return p.z + t * (q.z - p.z);
}

/// Whether the ray along +z from the point crosses the triangle.
bool crosses_above(const VertexArray& positions, const Triangle& triangle, const Vec3& point) {
  const auto z = find_crossing(positions, triangle, point);
  return z && *z > point.z();
}

/// Where the line along z through a point crosses a triangle.
struct Crossing {
  int triangle;
  double z;
};

bool is_within(const Bounds& bounds, const Vec3& point) {
  return (point.array() >= bounds.low.array()).all() &&
         (point.array() <= bounds.high.array()).all();
}

/// Of a point inside the surface the nearest crossing above it, none of a point outside.
std::optional<Crossing> find_exit_above(const SurfaceView& surface, const TriangleColumns& columns,
                                        const Vec3& point) {
  if (!is_within(columns.bounds(), point)) return {};
  bool inside = false;
  Crossing nearest{0, std::numeric_limits<double>::infinity()};
  columns.for_each_above(point, [&](int t) {
    const auto z = find_crossing(surface.positions, surface.topology.triangles()[at(t)], point);
    if (!z || !(*z > point.z())) return;
    inside = !inside;
    if (*z < nearest.z) nearest = {t, *z};
  });
  if (!inside) return {};
  return nearest;
}

/// The nearest crossing of all, given the nearest above the point.
Crossing find_nearest_crossing(const SurfaceView& surface, const TriangleColumns& columns,
                               const Vec3& point, const Crossing& above) {
  Crossing nearest = above;
  columns.for_each_below(point, [&](int t) {
    const auto z = find_crossing(surface.positions, surface.topology.triangles()[at(t)], point);
    if (z && std::abs(*z - point.z()) < std::abs(nearest.z - point.z())) nearest = {t, *z};
  });
  return nearest;
}

}  // namespace

// A ray through a vertex or along an edge must count each of them once (ERRATA row 17), whatever
// the rounding. The paper intersects the ray with each triangle's plane and asks whether the point
// lies in the triangle; triangle by triangle, nothing makes neighbours agree on the edge they
// share. Instead the mesh is sliced by the plane y = y(point). Every vertex is on one side of it
// (those on the plane itself count as before it, as if the plane lay a hair beyond), so the slice
// is a set of closed polygons: their corners are the edges with one end on either side, their sides
// the triangles. Which corners lie beyond x = x(point) is again decided once for each, so every
// polygon crosses the vertical line through the point an even number of times. A crossing counts
// when it is above the point, t > 0. All decisions but the last compare numbers that neighbours
// share; moving the corners by their rounding error moves the polygons by no more than that, so
// only points that near to the surface can be put on the wrong side.
bool is_inside(const SurfaceView& surface, const Vec3& point) {
  bool inside = false;
  for (const Triangle& triangle : surface.topology.triangles()) {
    if (crosses_above(surface.positions, triangle, point)) inside = !inside;
  }
  return inside;
}

std::optional<double> height_of_exit(const SurfaceView& surface, const Vec3& point) {
  bool inside = false;
  double lowest = std::numeric_limits<double>::infinity();
  for (const Triangle& triangle : surface.topology.triangles()) {
    const auto z = find_crossing(surface.positions, triangle, point);
    if (!z || !(*z > point.z())) continue;
    inside = !inside;
    lowest = std::min(lowest, *z);
  }
  if (!inside) return {};
  return lowest - point.z();
}

// The line through the point crosses the surface at a point of it: the nearest is no farther away,
// and hardly any triangle is as near.
std::optional<SurfaceExit> find_surface_exit(const SurfaceView& surface,
                                             const TriangleColumns& columns, const Vec3& point) {
  const auto above = find_exit_above(surface, columns, point);
  if (!above) return {};
  const Crossing crossing = find_nearest_crossing(surface, columns, point, *above);

  SurfaceExit exit;
  exit.depth = std::abs(crossing.z - point.z()) + columns.margin();
  double facing = 0.0;
  const auto reach = [&] { return exit.depth * (1.0 + same_distance); };  // shrinks
  const auto look = [&](int triangle) {
    const auto near = test_vertex_triangle(point, triangle_corners(surface, triangle), reach());
    if (!near) return reach();
    const Vec3 normal = feature_normal(surface, {FeatureKind::triangle, triangle});
    const double height = (near->second_point - point).dot(normal);
    if (near->distance < exit.depth * (1.0 - same_distance) || height > facing) {
      exit = {triangle, normal, near->second_point, near->distance};
      facing = height;
    }
    return reach();
  };
  look(crossing.triangle);
  columns.for_each_near(point, reach(), look);
  if (exit.normal.isZero(0.0)) return {};  // nothing but triangles without area: no way out
  return exit;
}

}  // namespace pneuma::sim

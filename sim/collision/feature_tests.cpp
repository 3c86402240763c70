#include "sim/collision/feature_tests.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {

namespace {

// The square of 1e-8. A triangle whose height is less than this fraction of its longest side counts
// as its three edges, and edges at a smaller angle have no trusted common normal. The square root
// of the rounding unit balances two errors: a direction taken from a cross product is wrong by
// rounding / sine, and without its face a sliver's nearest point moves by at most its height.
constexpr double squared_sine_of_parallel = 1e-16;

// The square of 0.1. Where edges are nearest is known to rounding over the square of the sine of
// their angle, and how near to rounding over the sine: for edges at more than this angle one pair
// of points is as good as all five.
constexpr double squared_sine_of_skew = 0.01;

struct PointOn {
  Vec3 position;
  FeaturePart part;
};

/// An edge, alone or of a triangle, that knows what its parts are called.
struct NamedEdge {
  Vec3 from;
  Vec3 to;
  int index;
  int from_index;
  int to_index;

  PointOn start() const { return {from, {FeatureKind::vertex, from_index}}; }
  PointOn end() const { return {to, {FeatureKind::vertex, to_index}}; }
  PointOn interior(const Vec3& position) const { return {position, {FeatureKind::edge, index}}; }
};

NamedEdge named(const Segment& edge) { return {edge[0], edge[1], 0, 0, 1}; }

std::array<NamedEdge, 3> edges_of(const Corners& t) {
  return {{{t[0], t[1], 0, 0, 1}, {t[1], t[2], 1, 1, 2}, {t[2], t[0], 2, 2, 0}}};
}

/// Keeps the nearest of all pairs of points offered that are closer than the reach. The paper stops
/// at the first it finds, often an edge's crossing or clamped end and not the nearest
/// (ERRATA row 24).
class NearestPair {
 public:
  explicit NearestPair(double reach) : squared_(reach * reach) {}

  double squared_reach() const { return squared_; }
  bool reaches(double distance) const { return distance * distance < squared_; }

  void offer(const PointOn& first, const PointOn& second) {
    const double squared = (first.position - second.position).squaredNorm();
    if (squared < squared_) {
      squared_ = squared;
      best_ = Proximity{0.0, first.position, second.position, first.part, second.part};
    }
  }

  /// What was first becomes second, for the "and vice versa" of the tests.
  void swap_sides() {
    if (best_) best_ = mirrored(*best_);
  }

  std::optional<Proximity> result() {
    if (best_) best_->distance = std::sqrt(squared_);
    return best_;
  }

 private:
  double squared_;
  std::optional<Proximity> best_;
};

struct Plane {
  Vec3 normal;  // unit, outward
  Vec3 origin;

  double height(const Vec3& point) const { return (point - origin).dot(normal); }
};

/// n = (t1 - t0) x (t2 - t0), outward for counter-clockwise triangles (ERRATA row 13). None for a
/// triangle without area, which is then no more than its edges.
std::optional<Plane> plane_of(const Corners& t) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double squared_side = std::max(
      {(t[1] - t[0]).squaredNorm(), (t[2] - t[1]).squaredNorm(), (t[0] - t[2]).squaredNorm()});
  const double squared_normal = normal.squaredNorm();
  if (!(squared_normal > squared_sine_of_parallel * squared_side * squared_side)) return {};
  return Plane{normal / std::sqrt(squared_normal), t[0]};
}

/// Whether a point lies over the triangle, seen along its normal. With a, b, c from the point to
/// the corners, p = b x c, q = c x a and r = a x b all point the triangle's way (ERRATA row 14).
/// The row's p.q >= 0 and p.r >= 0 also hold for p = 0, anywhere on the line through t1 and t2;
/// compared with the normal instead, only the side itself is inside.
bool lies_over(const Vec3& point, const Corners& t, const Vec3& normal) {
  const Vec3 a = t[0] - point;
  const Vec3 b = t[1] - point;
  const Vec3 c = t[2] - point;
  return b.cross(c).dot(normal) >= 0.0 && c.cross(a).dot(normal) >= 0.0 &&
         a.cross(b).dot(normal) >= 0.0;
}

/// Section 5.2.1.1.2: the vertex projected onto the edge's axis, or an end where it falls outside.
PointOn nearest_on_edge(const Vec3& point, const NamedEdge& edge) {
  const Vec3 axis = edge.to - edge.from;
  const double along = (point - edge.from).dot(axis);
  const double squared_length = axis.squaredNorm();
  // The comparisons also sort out an edge without length, so that nothing is divided by zero.
  if (along < 0.0 || squared_length == 0.0) return edge.start();
  if (along > squared_length) return edge.end();
  return edge.interior(edge.from + (along / squared_length) * axis);
}

/// The face of a triangle against a vertex, without the fall-backs.
void offer_vertex_face(NearestPair& nearest, const PointOn& vertex, double height,
                       const Corners& triangle, const Plane& plane) {
  if (!nearest.reaches(height) || !lies_over(vertex.position, triangle, plane.normal)) return;
  nearest.offer(vertex, {vertex.position - height * plane.normal, {FeatureKind::triangle, 0}});
}

/// The face of a triangle against an edge that passes through its plane: the crossing point of
/// section 5.2.1.1.5, t = ((t0 - e0).n) / ((e1 - e0).n), written with the ends' heights.
void offer_edge_face(NearestPair& nearest, const NamedEdge& edge, double from_height,
                     double to_height, const Corners& triangle, const Plane& plane) {
  const bool crosses = (from_height <= 0.0) != (to_height <= 0.0);
  if (!crosses) return;
  const double t = from_height / (from_height - to_height);
  const Vec3 crossing = edge.from + t * (edge.to - edge.from);
  if (!lies_over(crossing, triangle, plane.normal)) return;
  nearest.offer(edge.interior(crossing), {crossing, {FeatureKind::triangle, 0}});
}

/// The point of the first edge where the lines are nearest, t along it, and what is nearest to that
/// on the second; if that is an end, what is nearest to the end on the first. The squared distance
/// is a convex function of where the points are on their edges, and this its minimum (Ericson,
/// Real-Time Collision Detection, 5.1.9).
void offer_skew_edges(NearestPair& nearest, const NamedEdge& first, const NamedEdge& second,
                      double t) {
  const PointOn start = t <= 0.0   ? first.start()
                        : t >= 1.0 ? first.end()
                                   : first.interior(first.from + t * (first.to - first.from));
  const PointOn other = nearest_on_edge(start.position, second);
  const bool at_end = other.part.kind == FeatureKind::vertex;
  nearest.offer(at_end ? nearest_on_edge(other.position, first) : start, other);
}

/// Section 5.2.1.1.4. The line A + t n of the first edge meets the endless cylinder of the reach r
/// about the second, P + s d, where a t^2 + 2 b t + c = 0 with m = A - P, a = (d x n)^2,
/// b = (d x m).(d x n), c = (d x m)^2 - r^2 d^2. The middle of the two roots, t = -b / a, is where
/// the lines are nearest. By Lagrange's identity b^2 - a c = d^2 (r^2 a - (m.(d x n))^2): this form
/// of the discriminant does not cancel.
///
/// The paper falls back to the four pairs of ends and so misses an end next to the middle of the
/// other edge. The ends against the edges find it, and settle parallel edges (ERRATA row 16).
void offer_edge_edge(NearestPair& nearest, const NamedEdge& first, const NamedEdge& second) {
  const Vec3 n = first.to - first.from;
  const Vec3 d = second.to - second.from;
  const Vec3 m = first.from - second.from;
  const Vec3 across = d.cross(n);
  const double a = across.squaredNorm();
  const double distance = m.dot(across);
  const double squared_lengths = n.squaredNorm() * d.squaredNorm();
  const bool parallel = a <= squared_sine_of_parallel * squared_lengths;
  if (!parallel && distance * distance > nearest.squared_reach() * a) return;
  // However inexact t is for nearly parallel edges, moving along them hardly changes the distance.
  const double t = a > 0.0 ? -d.cross(m).dot(across) / a : 0.0;
  if (a > squared_sine_of_skew * squared_lengths) {
    return offer_skew_edges(nearest, first, second, t);
  }
  if (t > 0.0 && t < 1.0) {
    const Vec3 middle = first.from + t * n;
    nearest.offer(first.interior(middle), nearest_on_edge(middle, second));
  }
  nearest.offer(first.start(), nearest_on_edge(first.from, second));
  nearest.offer(first.end(), nearest_on_edge(first.to, second));
  nearest.offer(nearest_on_edge(second.from, first), second.start());
  nearest.offer(nearest_on_edge(second.to, first), second.end());
}

/// The heights of a triangle's corners over a plane.
struct Heights {
  std::array<double, 3> of;

  Heights(const Corners& t, const Plane& plane)
      : of{plane.height(t[0]), plane.height(t[1]), plane.height(t[2])} {}

  /// Whether all lie on one side and too far away.
  bool out_of_reach(const NearestPair& nearest) const {
    const auto [low, high] = std::minmax({of[0], of[1], of[2]});
    return (low > 0.0 && !nearest.reaches(low)) || (high < 0.0 && !nearest.reaches(high));
  }
};

void offer_triangle_face(NearestPair& nearest, const Corners& first, const Heights& heights,
                         const Corners& second, const Plane& plane) {
  const auto& h = heights.of;
  const std::array<NamedEdge, 3> edges = edges_of(first);
  offer_edge_face(nearest, edges[0], h[0], h[1], second, plane);
  offer_edge_face(nearest, edges[1], h[1], h[2], second, plane);
  offer_edge_face(nearest, edges[2], h[2], h[0], second, plane);
  offer_vertex_face(nearest, edges[0].start(), h[0], second, plane);
  offer_vertex_face(nearest, edges[1].start(), h[1], second, plane);
  offer_vertex_face(nearest, edges[2].start(), h[2], second, plane);
}

}  // namespace

Proximity mirrored(const Proximity& proximity) {
  return {proximity.distance, proximity.second_point, proximity.first_point, proximity.second,
          proximity.first};
}

// Section 5.2.1.1.1.
std::optional<Proximity> test_vertex_vertex(const Vec3& first, const Vec3& second, double reach) {
  NearestPair nearest(reach);
  nearest.offer({first, {}}, {second, {}});
  return nearest.result();
}

// Section 5.2.1.1.2: a sphere against a capsule. Where the projection lies beyond an end of the
// edge the vertex-vertex fall-back needs only that end.
std::optional<Proximity> test_vertex_edge(const Vec3& vertex, const Segment& edge, double reach) {
  NearestPair nearest(reach);
  nearest.offer({vertex, {}}, nearest_on_edge(vertex, named(edge)));
  return nearest.result();
}

// Section 5.2.1.1.3. A vertex that is not over the face falls back to the three edges, and through
// them to the corners (ERRATA row 15).
std::optional<Proximity> test_vertex_triangle(const Vec3& vertex, const Corners& triangle,
                                              double reach) {
  NearestPair nearest(reach);
  if (const auto plane = plane_of(triangle)) {
    const double height = plane->height(vertex);
    if (!nearest.reaches(height)) return {};
    offer_vertex_face(nearest, {vertex, {}}, height, triangle, *plane);
    if (auto over_face = nearest.result()) return over_face;
  }
  for (const NamedEdge& edge : edges_of(triangle)) {
    nearest.offer({vertex, {}}, nearest_on_edge(vertex, edge));
  }
  return nearest.result();
}

// Section 5.2.1.1.4.
std::optional<Proximity> test_edge_edge(const Segment& first, const Segment& second, double reach) {
  NearestPair nearest(reach);
  offer_edge_edge(nearest, named(first), named(second));
  return nearest.result();
}

// Section 5.2.1.1.5. The paper tests one point of the edge, where its line crosses the plane or the
// end next to that, against the triangle. An edge that passes beside the triangle, or is nearly
// parallel to it, is nearest with another point: so both ends are tested against the face, and the
// edge against the triangle's edges. This also settles an edge in the plane (ERRATA row 16).
std::optional<Proximity> test_edge_triangle(const Segment& edge, const Corners& triangle,
                                            double reach) {
  NearestPair nearest(reach);
  const NamedEdge whole = named(edge);
  if (const auto plane = plane_of(triangle)) {
    const double from_height = plane->height(whole.from);
    const double to_height = plane->height(whole.to);
    offer_edge_face(nearest, whole, from_height, to_height, triangle, *plane);
    offer_vertex_face(nearest, whole.start(), from_height, triangle, *plane);
    offer_vertex_face(nearest, whole.end(), to_height, triangle, *plane);
  }
  for (const NamedEdge& side : edges_of(triangle)) offer_edge_edge(nearest, whole, side);
  return nearest.result();
}

// Section 5.2.1.1.6: every edge and every vertex of one triangle against the other, and vice versa.
std::optional<Proximity> test_triangle_triangle(const Corners& first, const Corners& second,
                                                double reach) {
  NearestPair nearest(reach);
  const auto first_plane = plane_of(first);
  const auto second_plane = plane_of(second);
  if (second_plane) {
    const Heights heights(first, *second_plane);
    if (heights.out_of_reach(nearest)) return {};
    offer_triangle_face(nearest, first, heights, second, *second_plane);
  }
  if (first_plane) {
    const Heights heights(second, *first_plane);
    if (heights.out_of_reach(nearest)) return nearest.result();
    nearest.swap_sides();
    offer_triangle_face(nearest, second, heights, first, *first_plane);
    nearest.swap_sides();
  }
  for (const NamedEdge& edge : edges_of(first)) {
    for (const NamedEdge& other : edges_of(second)) offer_edge_edge(nearest, edge, other);
  }
  return nearest.result();
}

}  // namespace pneuma::sim

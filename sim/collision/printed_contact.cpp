// The feature tests and normals as printed: feature_contact.h.
#include <algorithm>
#include <cmath>

#include "sim/collision/feature_contact.h"

namespace pneuma::sim {
namespace {

/// A vertex, or a point of an edge that a test treats as one.
struct TestedPoint {
  Vec3 position;
  FeaturePart part;
};

/// An edge, alone or of a triangle.
struct TestedEdge {
  Vec3 from, to;
  FeaturePart part, from_part, to_part;
};

TestedPoint point_of(const Vec3& vertex) { return {vertex, {FeatureKind::vertex, 0}}; }

TestedEdge edge_of(const Segment& edge) {
  return {
      edge[0], edge[1], {FeatureKind::edge, 0}, {FeatureKind::vertex, 0}, {FeatureKind::vertex, 1}};
}

TestedPoint corner_of(const Corners& triangle, int i) {
  return {triangle[at(i)], {FeatureKind::vertex, i}};
}

TestedEdge side_of(const Corners& triangle, int i) {
  const int next = (i + 1) % 3;
  return {triangle[at(i)],
          triangle[at(next)],
          {FeatureKind::edge, i},
          {FeatureKind::vertex, i},
          {FeatureKind::vertex, next}};
}

/// 5.2.1.1.1.
std::optional<Proximity> vertex_vertex(const TestedPoint& first, const TestedPoint& second,
                                       double reach) {
  const double distance = (first.position - second.position).norm();
  if (!(distance < reach)) return {};
  return Proximity{distance, first.position, second.position, first.part, second.part};
}

/// 5.2.1.1.2: v_p is the projection onto the axis, which falls back to the ends beyond them.
std::optional<Proximity> vertex_edge(const TestedPoint& vertex, const TestedEdge& edge,
                                     double reach) {
  const Vec3 e = edge.to - edge.from;
  const double length = e.norm();
  const Vec3 axis = e / length;
  const double v_p = (vertex.position - edge.from).dot(axis);
  const Vec3 projected = edge.from + v_p * axis;
  const double distance = (vertex.position - projected).norm();
  if (!(distance < reach)) return {};
  if (0.0 <= v_p && v_p <= length) {
    return Proximity{distance, vertex.position, projected, vertex.part, edge.part};
  }
  if (auto found = vertex_vertex(vertex, {edge.from, edge.from_part}, reach)) return found;
  return vertex_vertex(vertex, {edge.to, edge.to_part}, reach);
}

Vec3 unit_normal(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]).normalized(); }

/// With the signs of ERRATA row 14.
bool is_in_triangle(const Vec3& point, const Corners& t, const Vec3& normal) {
  const Vec3 a = t[0] - point, b = t[1] - point, c = t[2] - point;
  return b.cross(c).dot(normal) >= 0.0 && c.cross(a).dot(normal) >= 0.0 &&
         a.cross(b).dot(normal) >= 0.0;
}

/// 5.2.1.1.3: three edge tests and three vertex tests where the vertex is not over the face
/// (ERRATA row 15).
std::optional<Proximity> vertex_triangle(const TestedPoint& vertex, const Corners& triangle,
                                         double reach) {
  const Vec3 normal = unit_normal(triangle);
  const double height = (vertex.position - triangle[0]).dot(normal);
  if (!(std::abs(height) < reach)) return {};
  const Vec3 projected = vertex.position - height * normal;
  if (is_in_triangle(projected, triangle, normal)) {
    return Proximity{
        std::abs(height), vertex.position, projected, vertex.part, {FeatureKind::triangle, 0}};
  }
  for (int i = 0; i < 3; ++i) {
    if (auto found = vertex_edge(vertex, side_of(triangle, i), reach)) return found;
  }
  for (int i = 0; i < 3; ++i) {
    if (auto found = vertex_vertex(vertex, corner_of(triangle, i), reach)) return found;
  }
  return {};
}

/// 5.2.1.1.4: the middle t = -b / a of the roots of a t^2 + 2 b t + c, where the first edge's line
/// is nearest to the second's. Beyond the edge the ends are tested; parallel edges have no t.
std::optional<Proximity> edge_edge(const TestedEdge& first, const TestedEdge& second,
                                   double reach) {
  const Vec3 n = first.to - first.from;
  const Vec3 m = first.from - second.from;
  const Vec3 d = second.to - second.from;
  const double a = d.cross(n).squaredNorm();
  const double b = d.cross(m).dot(d.cross(n));
  const double c = d.cross(m).squaredNorm() - reach * reach * d.squaredNorm();
  if (b * b - a * c < 0.0) return {};
  const double t = -b / a;
  if (t >= 0.0 && t <= 1.0) {
    if (auto found = vertex_edge({first.from + t * n, first.part}, second, reach)) return found;
  }
  const TestedPoint from{first.from, first.from_part}, to{first.to, first.to_part};
  for (const TestedPoint& end : {from, to}) {
    if (auto found = vertex_vertex(end, {second.from, second.from_part}, reach)) return found;
    if (auto found = vertex_vertex(end, {second.to, second.to_part}, reach)) return found;
  }
  return {};
}

/// 5.2.1.1.5: the point where the edge's line crosses the plane, or the end next to it. An edge
/// parallel to the triangle is ignored.
std::optional<Proximity> edge_triangle(const TestedEdge& edge, const Corners& triangle,
                                       double reach) {
  const Vec3 normal = unit_normal(triangle);
  const double along = (edge.to - edge.from).dot(normal);
  const double t = (triangle[0] - edge.from).dot(normal) / along;
  if (!std::isfinite(t)) return {};
  if (t < 0.0) return vertex_triangle({edge.from, edge.from_part}, triangle, reach);
  if (t > 1.0) return vertex_triangle({edge.to, edge.to_part}, triangle, reach);
  return vertex_triangle({edge.from + t * (edge.to - edge.from), edge.part}, triangle, reach);
}

std::optional<Proximity> all_of_triangle(const Corners& first, const Corners& second,
                                         double reach) {
  for (int i = 0; i < 3; ++i) {
    if (auto found = edge_triangle(side_of(first, i), second, reach)) return found;
  }
  for (int i = 0; i < 3; ++i) {
    if (auto found = vertex_triangle(corner_of(first, i), second, reach)) return found;
  }
  return {};
}

/// 5.2.1.1.6: every edge and every vertex of one triangle against the other, and vice versa.
std::optional<Proximity> triangle_triangle(const Corners& first, const Corners& second,
                                           double reach) {
  if (auto found = all_of_triangle(first, second, reach)) return found;
  auto found = all_of_triangle(second, first, reach);
  return found ? std::optional(mirrored(*found)) : std::nullopt;
}

/// The test for the lower-order feature first.
std::optional<Proximity> test_lower_first(const SurfaceView& low, Feature low_feature,
                                          const SurfaceView& high, Feature high_feature,
                                          double reach) {
  const int l = low_feature.index, h = high_feature.index;
  if (low_feature.kind == FeatureKind::vertex) {
    const TestedPoint vertex = point_of(low.positions[l]);
    switch (high_feature.kind) {
      case FeatureKind::vertex:
        return vertex_vertex(vertex, point_of(high.positions[h]), reach);
      case FeatureKind::edge:
        return vertex_edge(vertex, edge_of(edge_segment(high, h)), reach);
      case FeatureKind::triangle:
        return vertex_triangle(vertex, triangle_corners(high, h), reach);
    }
  }
  if (low_feature.kind == FeatureKind::edge) {
    const TestedEdge edge = edge_of(edge_segment(low, l));
    if (high_feature.kind == FeatureKind::edge) {
      return edge_edge(edge, edge_of(edge_segment(high, h)), reach);
    }
    return edge_triangle(edge, triangle_corners(high, h), reach);
  }
  return triangle_triangle(triangle_corners(low, l), triangle_corners(high, h), reach);
}

Vec3 unit_or_zero(const Vec3& vector) {
  const double length = vector.norm();
  return length > 0.0 ? Vec3(vector / length) : Vec3(Vec3::Zero());
}

Vec3 vertex_normal(const SurfaceView& surface, int vertex) {
  Vec3 sum = Vec3::Zero();
  for (const int triangle : surface.topology.vertex_triangles(vertex)) {
    sum += feature_normal(surface, {FeatureKind::triangle, triangle});
  }
  return unit_or_zero(sum);
}

/// v_p as the share of the edge's length: it is a length as printed (ERRATA row 12).
Vec3 edge_normal(const SurfaceView& surface, int edge, const Vec3& point) {
  const auto& [a, b] = surface.topology.edges()[at(edge)];
  const Vec3 from = surface.positions[a];
  const Vec3 e = Vec3(surface.positions[b]) - from;
  const double squared = e.squaredNorm();
  const double share = squared > 0.0 ? std::clamp((point - from).dot(e) / squared, 0.0, 1.0) : 0.0;
  return unit_or_zero((1.0 - share) * vertex_normal(surface, a) +
                      share * vertex_normal(surface, b));
}

/// The rule of 5.3.1, as in contact_normal.
Vec3 normal_of(const SurfaceView& first, const SurfaceView& second, const FeatureContact& contact) {
  const bool away_from_second = contact.second.kind >= contact.first.kind;
  const Vec3 normal = away_from_second
                          ? printed_normal(second, contact.second, contact.second_point)
                          : Vec3(-printed_normal(first, contact.first, contact.first_point));
  return normal.isZero(0.0) ? contact_normal(first, second, contact) : normal;
}

}  // namespace

Vec3 printed_normal(const SurfaceView& surface, Feature feature, const Vec3& point) {
  switch (feature.kind) {
    case FeatureKind::vertex:
      return vertex_normal(surface, feature.index);
    case FeatureKind::edge:
      return edge_normal(surface, feature.index, point);
    case FeatureKind::triangle:
      break;
  }
  return feature_normal(surface, feature);
}

std::optional<FeatureContact> find_printed_contact(const SurfaceView& first, Feature first_feature,
                                                   const SurfaceView& second,
                                                   Feature second_feature, double reach) {
  const bool in_order = first_feature.kind <= second_feature.kind;
  auto found = in_order ? test_lower_first(first, first_feature, second, second_feature, reach)
                        : test_lower_first(second, second_feature, first, first_feature, reach);
  if (!found) return {};
  if (!in_order) found = mirrored(*found);
  FeatureContact contact = to_contact(first, first_feature, second, second_feature, *found);
  contact.normal = normal_of(first, second, contact);
  return contact;
}

}  // namespace pneuma::sim

#include "sim/swept/closest_points.h"

namespace pneuma::sim {
namespace {

/// Of a point on the line through two others.
double fraction(const Vec3& from, const Vec3& to, const Vec3& point) {
  const Vec3 way = to - from;
  return (point - from).dot(way) / way.squaredNorm();
}

/// Of a point on a triangle with an area.
FeatureWeights weights_on_face(const Corners& t, const Vec3& point) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double v = (t[2] - t[0]).cross(point - t[0]).dot(-normal) / normal.squaredNorm();
  const double w = (t[1] - t[0]).cross(point - t[0]).dot(normal) / normal.squaredNorm();
  return {1.0 - v - w, v, w};
}

/// `corners`: of the feature, as many as it has.
template <std::size_t Count>
FeatureWeights weights(const std::array<Vec3, Count>& corners, const FeaturePart& part,
                       const Vec3& point) {
  FeatureWeights result{};
  const std::size_t i = at(part.index);
  switch (part.kind) {
    case FeatureKind::vertex:
      result[i] = 1.0;
      break;
    case FeatureKind::edge: {
      const std::size_t next = (i + 1) % Count;
      result[next] = fraction(corners[i], corners[next], point);
      result[i] = 1.0 - result[next];
      break;
    }
    case FeatureKind::triangle:
      if constexpr (Count == 3) result = weights_on_face(corners, point);
      break;
  }
  return result;
}

template <std::size_t First, std::size_t Second>
std::optional<ClosestPoints> with_weights(const std::optional<Proximity>& found,
                                          const std::array<Vec3, First>& first,
                                          const std::array<Vec3, Second>& second) {
  if (!found) return std::nullopt;
  const Proximity& proximity = *found;
  return ClosestPoints{.first_point = proximity.first_point,
                       .second_point = proximity.second_point,
                       .first_weights = weights(first, proximity.first, proximity.first_point),
                       .second_weights = weights(second, proximity.second, proximity.second_point),
                       .first = proximity.first,
                       .second = proximity.second,
                       .distance = proximity.distance};
}

}  // namespace

ClosestPoints mirrored(const ClosestPoints& closest) {
  return {closest.second_point, closest.first_point, closest.second_weights, closest.first_weights,
          closest.second,       closest.first,       closest.distance};
}

std::optional<ClosestPoints> closest_vertex_triangle(const Vec3& vertex, const Corners& triangle,
                                                     double reach) {
  return with_weights(test_vertex_triangle(vertex, triangle, reach), std::array{vertex}, triangle);
}

std::optional<ClosestPoints> closest_edge_edge(const Segment& first, const Segment& second,
                                               double reach) {
  return with_weights(test_edge_edge(first, second, reach), first, second);
}

}  // namespace pneuma::sim

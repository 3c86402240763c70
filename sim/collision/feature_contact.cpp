#include "sim/collision/feature_contact.h"

#include "sim/collision/feature_tests.h"

namespace pneuma::sim {

namespace {

/// The test for the lower-order feature first.
std::optional<Proximity> test_ordered(const SurfaceView& low, Feature low_feature,
                                      const SurfaceView& high, Feature high_feature, double reach) {
  const int l = low_feature.index;
  const int h = high_feature.index;
  switch (low_feature.kind) {
    case FeatureKind::vertex:
      switch (high_feature.kind) {
        case FeatureKind::vertex:
          return test_vertex_vertex(low.positions[l], high.positions[h], reach);
        case FeatureKind::edge:
          return test_vertex_edge(low.positions[l], edge_segment(high, h), reach);
        case FeatureKind::triangle:
          return test_vertex_triangle(low.positions[l], triangle_corners(high, h), reach);
      }
      break;
    case FeatureKind::edge:
      if (high_feature.kind == FeatureKind::edge) {
        return test_edge_edge(edge_segment(low, l), edge_segment(high, h), reach);
      }
      return test_edge_triangle(edge_segment(low, l), triangle_corners(high, h), reach);
    case FeatureKind::triangle:
      break;
  }
  return test_triangle_triangle(triangle_corners(low, l), triangle_corners(high, h), reach);
}

}  // namespace

Feature part_of(const MeshTopology& topology, Feature feature, FeaturePart part) {
  if (part.kind == feature.kind) return feature;
  const auto i = at(part.index);
  if (part.kind == FeatureKind::vertex) {
    return {FeatureKind::vertex, topology.feature_vertices(feature)[i]};
  }
  return {FeatureKind::edge, topology.triangle_edges()[at(feature.index)][i]};
}

Vec3 contact_normal(const SurfaceView& first, const SurfaceView& second,
                    const FeatureContact& contact) {
  const bool away_from_second = contact.second.kind >= contact.first.kind;
  const Vec3 normal = away_from_second ? feature_normal(second, contact.second)
                                       : Vec3(-feature_normal(first, contact.first));
  if (!normal.isZero(0.0)) return normal;
  // A crumpled surface without a normal of its own: apart, or upwards when the points coincide.
  const Vec3 apart = contact.first_point - contact.second_point;
  return contact.distance > 0.0 ? Vec3(apart / contact.distance) : Vec3::UnitZ();
}

FeatureContact to_contact(const SurfaceView& first, Feature first_feature,
                          const SurfaceView& second, Feature second_feature,
                          const Proximity& proximity) {
  return {.first = part_of(first.topology, first_feature, proximity.first),
          .second = part_of(second.topology, second_feature, proximity.second),
          .first_point = proximity.first_point,
          .second_point = proximity.second_point,
          .normal = Vec3::Zero(),
          .distance = proximity.distance};
}

std::optional<FeatureContact> find_touching_parts(const SurfaceView& first, Feature first_feature,
                                                  const SurfaceView& second, Feature second_feature,
                                                  double reach) {
  const bool in_order = first_feature.kind <= second_feature.kind;
  auto near = in_order ? test_ordered(first, first_feature, second, second_feature, reach)
                       : test_ordered(second, second_feature, first, first_feature, reach);
  if (!near) return {};
  if (!in_order) near = mirrored(*near);
  return to_contact(first, first_feature, second, second_feature, *near);
}

std::optional<FeatureContact> find_feature_contact(const SurfaceView& first, Feature first_feature,
                                                   const SurfaceView& second,
                                                   Feature second_feature, double reach) {
  auto contact = find_touching_parts(first, first_feature, second, second_feature, reach);
  if (contact) contact->normal = contact_normal(first, second, *contact);
  return contact;
}

}  // namespace pneuma::sim

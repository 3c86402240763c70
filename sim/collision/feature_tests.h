// The six feature tests of section 5.2.1.1: do two features lie closer than the reach, and where?
//
// Plain geometry, without normals: feature_contact.h adds those. Lengths in metres. Two features
// are in contact when their nearest points are less than `reach` apart; the paper's reach is twice
// the skin thickness (ERRATA row 46). Every finite input is allowed, edges without length and
// triangles without area too, as long as coordinates stay below 1e70: their fourth powers must be
// finite.
#pragma once

#include <array>
#include <optional>

#include "sim/mesh/topology.h"

namespace pneuma::sim {

using Segment = std::array<Vec3, 2>;
using Corners = std::array<Vec3, 3>;  // counter-clockwise seen from outside

/// Which part of a feature the nearest point is on: the feature itself (index 0), end 0 or 1 of an
/// edge, corner 0 to 2 of a triangle, or its edge 0 to 2, where edge i joins corners i and i + 1.
struct FeaturePart {
  FeatureKind kind = FeatureKind::vertex;
  int index = 0;

  friend bool operator==(const FeaturePart&, const FeaturePart&) = default;
};

/// The nearest points of two features and the parts they are on.
struct Proximity {
  double distance = 0.0;  // m, 0 when they touch or cross
  Vec3 first_point = Vec3::Zero();
  Vec3 second_point = Vec3::Zero();
  FeaturePart first;
  FeaturePart second;
};

/// The same with first and second exchanged.
Proximity mirrored(const Proximity& proximity);

std::optional<Proximity> test_vertex_vertex(const Vec3& first, const Vec3& second, double reach);
std::optional<Proximity> test_vertex_edge(const Vec3& vertex, const Segment& edge, double reach);
std::optional<Proximity> test_vertex_triangle(const Vec3& vertex, const Corners& triangle,
                                              double reach);
std::optional<Proximity> test_edge_edge(const Segment& first, const Segment& second, double reach);
std::optional<Proximity> test_edge_triangle(const Segment& edge, const Corners& triangle,
                                            double reach);
std::optional<Proximity> test_triangle_triangle(const Corners& first, const Corners& second,
                                                double reach);

}  // namespace pneuma::sim

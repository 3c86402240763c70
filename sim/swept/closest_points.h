// Where two features are nearest, as weights of their vertices: what an impulse at that place
// needs.
//
// The feature tests of section 5.2.1.1 (feature_tests.h), of the two pairs of features alone of
// which every way of touching is made: vertex and triangle, edge and edge.
#pragma once

#include <array>
#include <optional>

#include "sim/collision/feature_tests.h"

namespace pneuma::sim {

/// Of the vertices of a feature, in its own order; they sum to 1. A vertex has one, an edge two.
using FeatureWeights = std::array<double, 3>;

struct ClosestPoints {
  Vec3 first_point = Vec3::Zero();  // m
  Vec3 second_point = Vec3::Zero();
  FeatureWeights first_weights{};
  FeatureWeights second_weights{};
  FeaturePart first;  // which part of each feature its point is on
  FeaturePart second;
  double distance = 0.0;  // m
};

/// The same with first and second exchanged.
ClosestPoints mirrored(const ClosestPoints& closest);

/// None if they are `reach` (m) apart, or more. Every finite input is allowed, features without
/// extent too (feature_tests.h).
std::optional<ClosestPoints> closest_vertex_triangle(const Vec3& vertex, const Corners& triangle,
                                                     double reach);
std::optional<ClosestPoints> closest_edge_edge(const Segment& first, const Segment& second,
                                               double reach);

}  // namespace pneuma::sim

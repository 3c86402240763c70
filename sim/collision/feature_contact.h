// Two features of two soft bodies in contact: the feature tests on meshes, and the normal rule.
#pragma once

#include <optional>

#include "sim/collision/surface_view.h"

namespace pneuma::sim {

/// What really touches: a triangle that is met at a corner is reported as that vertex.
struct FeatureContact {
  Feature first;
  Feature second;
  Vec3 first_point = Vec3::Zero();  // the nearest points, m
  Vec3 second_point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  // unit; the impulse on the first body is along +normal
  double distance = 0.0;       // m between the nearest points, never negative
};

/// Runs the test of section 5.2.1.1 that fits the kinds of the two features. None unless they are
/// less than `reach` (m, the paper's 2 x skin thickness) apart.
std::optional<FeatureContact> find_feature_contact(const SurfaceView& first, Feature first_feature,
                                                   const SurfaceView& second,
                                                   Feature second_feature, double reach);

}  // namespace pneuma::sim

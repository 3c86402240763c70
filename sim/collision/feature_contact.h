// Two features of two soft bodies in contact: the feature tests on meshes, and the normal rule.
#pragma once

#include <optional>

#include "sim/collision/surface_view.h"

namespace pneuma::sim {

/// What really touches: a triangle that is met at a corner is reported as that vertex
/// (ERRATA row 47).
struct FeatureContact {
  Feature first;
  Feature second;
  Vec3 first_point = Vec3::Zero();  // the nearest points, m
  Vec3 second_point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  // unit; the impulse on the first body is along +normal
  double distance = 0.0;       // m between the nearest points, never negative
};

/// The part of a feature as a feature of the mesh.
Feature part_of(const MeshTopology& topology, Feature feature, FeaturePart part);

/// Where two features are near each other, written for the mesh, without a normal.
FeatureContact to_contact(const SurfaceView& first, Feature first_feature,
                          const SurfaceView& second, Feature second_feature,
                          const Proximity& proximity);

/// Runs the test of section 5.2.1.1 that fits the kinds of the two features. None unless they are
/// less than `reach` (m, the paper's 2 x skin thickness) apart.
std::optional<FeatureContact> find_feature_contact(const SurfaceView& first, Feature first_feature,
                                                   const SurfaceView& second,
                                                   Feature second_feature, double reach);

/// The same but for the normal, which is zero.
std::optional<FeatureContact> find_touching_parts(const SurfaceView& first, Feature first_feature,
                                                  const SurfaceView& second, Feature second_feature,
                                                  double reach);

/// Section 5.3.1, ERRATA row 20: away from the higher-order feature towards the lower-order one,
/// and for equal orders away from the second. It is the surface's own normal, not the direction
/// between the nearest points, so that it still points out of bodies that overlap.
Vec3 contact_normal(const SurfaceView& first, const SurfaceView& second,
                    const FeatureContact& contact);

// The six tests in the paper's order with its fall-backs, each ending at the first contact that it
// comes to, and the paper's normals (ERRATA rows 12, 24, 48 and 68): printed_contact.cpp.

/// The contact is between the features of the test that found it; one that falls back hands over to
/// another.
std::optional<FeatureContact> find_printed_contact(const SurfaceView& first, Feature first_feature,
                                                   const SurfaceView& second,
                                                   Feature second_feature, double reach);

/// Outward unit normal at a point of a feature: of a vertex the average of its triangles' unit
/// normals, of an edge interpolated between those of its ends. Zero where it does not exist.
Vec3 printed_normal(const SurfaceView& surface, Feature feature, const Vec3& point);

}  // namespace pneuma::sim

// The nearest points of features against the true distance, by enumeration.
#include "sim/swept/closest_points.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/sim/collision/feature_samples.h"

namespace pneuma::sim {
namespace {

Vec3 at_weights(const Points& corners, const FeatureWeights& weights) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) sum += weights[i] * corners[i];
  return sum;
}

double sum(const FeatureWeights& weights) { return weights[0] + weights[1] + weights[2]; }

/// How many weights are not zero: of a point on that part of its feature.
int corners_of(FeatureKind part) { return static_cast<int>(part) + 1; }

void expect_weights(const Points& feature, const FeatureWeights& weights, const Vec3& point,
                    FeaturePart part, double tolerance) {
  EXPECT_NEAR(sum(weights), 1.0, 1e-12);
  EXPECT_LE((at_weights(feature, weights) - point).norm(), tolerance);
  int used = 0;
  for (const double weight : weights) {
    EXPECT_GE(weight, -1e-12);
    used += weight != 0.0 ? 1 : 0;
  }
  EXPECT_LE(used, corners_of(part.kind));
}

/// As near as a pair of them can be, where their weights say.
void expect_closest(const FeaturePair& pair, const ClosestPoints& closest) {
  const double truth = reference_distance(pair.first, pair.second);
  EXPECT_NEAR(closest.distance, truth, pair.tolerance);
  expect_weights(pair.first, closest.first_weights, closest.first_point, closest.first,
                 pair.tolerance);
  expect_weights(pair.second, closest.second_weights, closest.second_point, closest.second,
                 pair.tolerance);
}

constexpr int feature_pairs = 20'000;
constexpr double any_distance = std::numeric_limits<double>::infinity();

TEST(ClosestPoints, OfVertexAndTriangleAreAtTheTrueDistance) {
  FeatureSampler sampler(1);
  for (int i = 0; i < feature_pairs && !testing::Test::HasFailure(); ++i) {
    const FeaturePair pair = sampler.sample(1, 3, i % FeatureSampler::relations);
    expect_closest(pair,
                   *closest_vertex_triangle(pair.first[0], corners(pair.second), any_distance));
  }
}

TEST(ClosestPoints, OfTwoEdgesAreAtTheTrueDistance) {
  FeatureSampler sampler(2);
  for (int i = 0; i < feature_pairs && !testing::Test::HasFailure(); ++i) {
    const FeaturePair pair = sampler.sample(2, 2, i % FeatureSampler::relations);
    expect_closest(pair,
                   *closest_edge_edge(segment(pair.first), segment(pair.second), any_distance));
  }
}

TEST(ClosestPoints, SayWhichPartTheyAreOn) {
  const Corners triangle = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const auto part = [&](double x, double y) {
    return closest_vertex_triangle({x, y, 1.0}, triangle, any_distance)->second;
  };
  EXPECT_EQ(part(0.2, 0.2), (FeaturePart{FeatureKind::triangle, 0}));
  EXPECT_EQ(part(-1.0, -1.0), (FeaturePart{FeatureKind::vertex, 0}));
  EXPECT_EQ(part(2.0, -1.0), (FeaturePart{FeatureKind::vertex, 1}));
  EXPECT_EQ(part(-1.0, 2.0), (FeaturePart{FeatureKind::vertex, 2}));
  EXPECT_EQ(part(0.5, -1.0), (FeaturePart{FeatureKind::edge, 0}));
  EXPECT_EQ(part(1.0, 1.0), (FeaturePart{FeatureKind::edge, 1}));
  EXPECT_EQ(part(-1.0, 0.5), (FeaturePart{FeatureKind::edge, 2}));
}

}  // namespace
}  // namespace pneuma::sim

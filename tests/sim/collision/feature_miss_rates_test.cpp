// What the feature tests gain by looking for the nearest points: the share of contacts that the
// tests miss as the paper words them, with only the corrections of ERRATA rows 13 to 16.
#include <gtest/gtest.h>

#include "sim/collision/feature_tests.h"
#include "tests/sim/collision/feature_samples.h"

namespace pneuma::sim {
namespace {

/// 5.2.1.1.4: the middle of the crossings of the first edge's line with the capsule, against the
/// second edge; failing that, ends against ends.
bool edge_edge_as_printed(const Segment& first, const Segment& second, double reach) {
  const Vec3 n = first[1] - first[0];
  const Vec3 m = first[0] - second[0];
  const Vec3 d = second[1] - second[0];
  const double a = d.cross(n).squaredNorm();
  const double b = d.cross(m).dot(d.cross(n));
  const double c = d.cross(m).squaredNorm() - reach * reach * d.squaredNorm();
  if (b * b - a * c < 0.0) return false;
  const double t = -b / a;
  if (t >= 0.0 && t <= 1.0 && test_vertex_edge(first[0] + t * n, second, reach)) return true;
  for (const Vec3& end : first) {
    for (const Vec3& other : second) {
      if (test_vertex_vertex(end, other, reach)) return true;
    }
  }
  return false;
}

/// 5.2.1.1.5: the point where the edge's line crosses the plane, or the end next to it.
bool edge_triangle_as_printed(const Segment& edge, const Corners& triangle, double reach) {
  const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double t = (triangle[0] - edge[0]).dot(normal) / (edge[1] - edge[0]).dot(normal);
  const Vec3 point = edge[0] + std::clamp(t, 0.0, 1.0) * (edge[1] - edge[0]);
  return test_vertex_triangle(point, triangle, reach).has_value();
}

/// 5.2.1.1.6.
bool triangle_triangle_as_printed(const Corners& first, const Corners& second, double reach) {
  const auto meets = [reach](const Corners& a, const Corners& b) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (edge_triangle_as_printed({a[i], a[(i + 1) % 3]}, b, reach)) return true;
      if (test_vertex_triangle(a[i], b, reach)) return true;
    }
    return false;
  };
  return meets(first, second) || meets(second, first);
}

/// Counts on pairs of the paper's proportions, edges of about 1 to 3 units and a reach of 1. The
/// expected share is a record of what the paper's wording costs, not derived from anything; it is a
/// mean over some thousand contacts, so four standard deviations are its tolerance.
void expect_misses(std::size_t first, std::size_t second, double share_as_printed,
                   bool (*as_printed)(const FeaturePair&)) {
  FeatureSampler sampler(7);
  int contacts = 0;
  int missed_as_printed = 0;
  for (int i = 0; i < 20'000; ++i) {
    const FeaturePair pair = sampler.sample(first, second, 0);
    if (reference_distance(pair.first, pair.second) >= pair.reach) continue;
    ++contacts;
    if (!as_printed(pair)) ++missed_as_printed;
    EXPECT_TRUE(test_features(pair.first, pair.second, pair.reach)) << "pair " << i;
  }
  ASSERT_GT(contacts, 1000);
  const double deviation = std::sqrt(share_as_printed * (1.0 - share_as_printed) / contacts);
  EXPECT_NEAR(static_cast<double>(missed_as_printed) / contacts, share_as_printed, 4.0 * deviation);
}

TEST(FeatureMissRates, EdgeEdgeAsPrintedMissesOneContactInEight) {
  expect_misses(2, 2, 0.13, [](const FeaturePair& p) {
    return edge_edge_as_printed(segment(p.first), segment(p.second), p.reach);
  });
}

TEST(FeatureMissRates, EdgeTriangleAsPrintedMissesOneContactInFive) {
  expect_misses(2, 3, 0.19, [](const FeaturePair& p) {
    return edge_triangle_as_printed(segment(p.first), corners(p.second), p.reach);
  });
}

TEST(FeatureMissRates, TriangleTriangleAsPrintedMissesOneContactInAHundred) {
  expect_misses(3, 3, 0.01, [](const FeaturePair& p) {
    return triangle_triangle_as_printed(corners(p.first), corners(p.second), p.reach);
  });
}

}  // namespace
}  // namespace pneuma::sim

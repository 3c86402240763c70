// What the feature tests gain by looking for the nearest points (ERRATA row 24): prints the share
// of contacts that tests miss as the paper words them, with only the corrections of ERRATA rows 13
// to 16, and that ours miss.
#include <cstdio>

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

/// Counts on pairs of the paper's proportions, edges of about 1 to 3 units and a reach of 1.
void print_misses(const char* kind, std::size_t first, std::size_t second,
                  bool (*as_printed)(const FeaturePair&)) {
  FeatureSampler sampler(7);
  int contacts = 0, missed_as_printed = 0, missed_by_ours = 0;
  for (int i = 0; i < 20'000; ++i) {
    const FeaturePair pair = sampler.sample(first, second, 0);
    if (reference_distance(pair.first, pair.second) >= pair.reach) continue;
    ++contacts;
    if (!as_printed(pair)) ++missed_as_printed;
    if (!test_features(pair.first, pair.second, pair.reach)) ++missed_by_ours;
  }
  std::printf("%-18s %9d %11.1f %% %7.1f %%\n", kind, contacts,
              100.0 * missed_as_printed / contacts, 100.0 * missed_by_ours / contacts);
}

}  // namespace
}  // namespace pneuma::sim

int main() {
  using namespace pneuma::sim;
  std::printf("%-18s %9s %13s %9s\n", "missed by tests", "contacts", "as printed", "ours");
  print_misses("edge, edge", 2, 2, [](const FeaturePair& p) {
    return edge_edge_as_printed(segment(p.first), segment(p.second), p.reach);
  });
  print_misses("edge, triangle", 2, 3, [](const FeaturePair& p) {
    return edge_triangle_as_printed(segment(p.first), corners(p.second), p.reach);
  });
  print_misses("triangle, triangle", 3, 3, [](const FeaturePair& p) {
    return triangle_triangle_as_printed(corners(p.first), corners(p.second), p.reach);
  });
}

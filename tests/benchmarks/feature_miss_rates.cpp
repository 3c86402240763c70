// What the feature tests gain by looking for the nearest points (ERRATA row 24): prints the share
// of contacts that tests miss as the paper words them, with only the corrections of ERRATA rows 13
// to 16, and that ours miss.
#include <algorithm>
#include <cstdio>

#include "sim/collision/feature_contact.h"
#include "tests/sim/collision/feature_samples.h"
#include "tests/sim/collision/surface_body.h"

namespace pneuma::sim {
namespace {

/// The corner that a feature lacks for a tetrahedron; no test looks at it.
const Vec3 elsewhere = {1e3, 2e3, 3e3};

/// A tetrahedron with the feature of these corners: an edge from its vertex 0 to 1, or its first
/// triangle.
SurfaceBody body_with(const Points& points) {
  TriangleMesh mesh;
  mesh.vertices = points;
  while (mesh.vertices.size() < 4) {
    mesh.vertices.push_back(static_cast<double>(mesh.vertices.size()) * elsewhere);
  }
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  return SurfaceBody(mesh);
}

Feature feature_of(const SurfaceBody& body, const Points& points) {
  if (points.size() == 3) return {FeatureKind::triangle, 0};
  const auto& edges = body.topology.edges();
  const auto between_0_and_1 = [](const auto& edge) { return edge[0] + edge[1] == 1; };
  const auto first = std::ranges::find_if(edges, between_0_and_1);
  return {FeatureKind::edge, static_cast<int>(first - edges.begin())};
}

bool touch_as_printed(const FeaturePair& pair) {
  const SurfaceBody first = body_with(pair.first), second = body_with(pair.second);
  return find_printed_contact(first.surface(), feature_of(first, pair.first), second.surface(),
                              feature_of(second, pair.second), pair.reach)
      .has_value();
}

/// Counts on pairs of the paper's proportions, edges of about 1 to 3 units and a reach of 1.
void print_misses(const char* kind, std::size_t first, std::size_t second) {
  FeatureSampler sampler(7);
  int contacts = 0, missed_as_printed = 0, missed_by_ours = 0;
  for (int i = 0; i < 20'000; ++i) {
    const FeaturePair pair = sampler.sample(first, second, 0);
    if (reference_distance(pair.first, pair.second) >= pair.reach) continue;
    ++contacts;
    if (!touch_as_printed(pair)) ++missed_as_printed;
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
  print_misses("edge, edge", 2, 2);
  print_misses("edge, triangle", 2, 3);
  print_misses("triangle, triangle", 3, 3);
}

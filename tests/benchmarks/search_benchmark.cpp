// Time of the search for features of two surfaces that may touch, beside that of looking at every
// pair of features: both find the same or more (tests/sim/swept/moving_surface_test.cpp). Not a
// test: run it by hand, see README.md.

#include <benchmark/benchmark.h>

#include "sim/mesh/primitives.h"
#include "sim/mesh/soft_mesh.h"
#include "sim/swept/moving_surface.h"

namespace pneuma::benchmarks {
namespace {

using namespace sim;

constexpr double radius = 3.0;   // m
constexpr double margin = 0.02;  // m

/// A ball that moves by 2 cm towards the origin in the step, as at 1.2 m/s.
MovingSurface make_surface(const SoftMesh& mesh, double x) {
  MovingSurface surface;
  surface.tree = std::make_shared<SurfaceTree>(mesh.topology, mesh.rest_positions, false);
  surface.start = mesh.rest_positions;
  for (int v = 0; v < surface.start.size(); ++v) surface.start[v].x() += x;
  surface.end = surface.start;
  for (int v = 0; v < surface.end.size(); ++v) surface.end[v].x() -= x > 0.0 ? 0.02 : -0.02;
  return surface;
}

std::vector<WayBox> edge_boxes(const MovingSurface& surface) {
  std::vector<WayBox> boxes;
  for (const auto& [a, b] : surface.tree->topology().edges()) {
    boxes.push_back(surface.vertices[at(a)]);
    boxes.back().include(surface.vertices[at(b)]);
  }
  return boxes;
}

void pair_up(const std::vector<WayBox>& a, FeatureKind of_a, const std::vector<WayBox>& b,
             FeatureKind of_b, std::vector<NearFeatures>& pairs) {
  for (int i = 0; i < static_cast<int>(a.size()); ++i) {
    for (int j = 0; j < static_cast<int>(b.size()); ++j) {
      if (overlap(a[at(i)], b[at(j)])) pairs.push_back({{of_a, i}, {of_b, j}});
    }
  }
}

void look_at_all(const MovingSurface& a, const MovingSurface& b, std::vector<NearFeatures>& pairs) {
  pair_up(a.vertices, FeatureKind::vertex, b.triangles, FeatureKind::triangle, pairs);
  pair_up(a.triangles, FeatureKind::triangle, b.vertices, FeatureKind::vertex, pairs);
  pair_up(edge_boxes(a), FeatureKind::edge, edge_boxes(b), FeatureKind::edge, pairs);
}

template <class Find>
void measure(benchmark::State& state, Find find) {
  const auto mesh = make_soft_mesh(make_icosphere(radius, static_cast<int>(state.range(0))));
  MovingSurface a = make_surface(*mesh, radius + margin);
  MovingSurface b = make_surface(*mesh, -radius - margin);
  std::vector<NearFeatures> pairs;
  for ([[maybe_unused]] const auto _ : state) {
    pairs.clear();
    refit(a, 0.5 * margin);
    refit(b, 0.5 * margin);
    find(a, b, pairs);
  }
  state.counters["vertices"] = a.start.size();
  state.counters["pairs"] = static_cast<double>(pairs.size());
}

void of_hierarchy(benchmark::State& state) {
  measure(state,
          [](const MovingSurface& first, const MovingSurface& second,
             std::vector<NearFeatures>& pairs) { find_near_features(first, second, pairs); });
}
void of_everything(benchmark::State& state) { measure(state, look_at_all); }

BENCHMARK(of_hierarchy)->DenseRange(1, 5)->Unit(benchmark::kMicrosecond);
BENCHMARK(of_everything)->DenseRange(1, 5)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pneuma::benchmarks

BENCHMARK_MAIN();

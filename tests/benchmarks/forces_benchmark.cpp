// Time of one force evaluation: per vertex, in nanoseconds, the least of all repeats ("least"),
// which other programs on the machine disturb the least. Not a test: run it by hand, see README.md.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <numeric>
#include <queue>
#include <random>

#include "sim/soft/integrators.h"
#include "tests/benchmarks/layouts.h"
#include "tests/support/worlds.h"

namespace pneuma::benchmarks {
namespace {

using namespace sim;

struct Shape {
  std::string name;
  TriangleMesh mesh;
};

/// The same mesh with its vertices renumbered: the i-th becomes order[i].
TriangleMesh renumbered(const TriangleMesh& mesh, const std::vector<int>& order) {
  TriangleMesh result = mesh;
  for (std::size_t v = 0; v < order.size(); ++v) {
    result.vertices[at(order[v])] = mesh.vertices[v];
  }
  for (Triangle& triangle : result.triangles) {
    for (int& v : triangle) v = order[at(v)];
  }
  return result;
}

TriangleMesh shuffled(const TriangleMesh& mesh) {
  std::vector<int> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  return renumbered(mesh, order);
}

/// Neighbours near each other in memory: breadth first from vertex 0 (Cuthill and McKee 1969).
TriangleMesh breadth_first(const TriangleMesh& mesh) {
  const MeshTopology topology(static_cast<int>(mesh.vertices.size()), mesh.triangles);
  std::vector<int> order(mesh.vertices.size(), -1);
  std::queue<int> waiting({0});
  order[0] = 0;
  for (int met = 1; !waiting.empty(); waiting.pop()) {
    for (const auto& spoke : topology.ring(waiting.front())) {
      if (order[at(spoke.vertex)] >= 0) continue;
      order[at(spoke.vertex)] = met++;
      waiting.push(spoke.vertex);
    }
  }
  return renumbered(mesh, order);
}

/// Of 58, 256, 642, 2,562 and 10,242 vertices.
std::vector<Shape> shapes() {
  return {{"sphere_58", make_sphere(3.0, 8, 8)},
          {"torus_256", make_torus(6.0, 2.0, 16, 16)},
          {"icosphere_642", make_icosphere(3.0, 3)},
          {"icosphere_2562", make_icosphere(3.0, 4)},
          {"icosphere_10242", make_icosphere(3.0, 5)}};
}

/// The last one in other orders of its vertices.
std::vector<Shape> orders() {
  const TriangleMesh mesh = make_icosphere(3.0, 5);
  return {{"icosphere_10242_breadth_first", breadth_first(mesh)},
          {"icosphere_10242_shuffled", shuffled(mesh)}};
}

SoftBody make_test_body(const TriangleMesh& mesh, bool dashpots) {
  SoftBody body = make_body(mesh);
  perturb(body, 0.01, 1);
  if (!dashpots) undamp(body.material);
  return body;
}

/// Calls work() again and again, some 50 us a piece, and reports the least time of one call over
/// `share`, its vertices times its evaluations.
template <class Work>
void measure(benchmark::State& state, double share, const Work& work) {
  using Clock = std::chrono::steady_clock;
  const int calls = std::max(1, static_cast<int>(5000.0 / share));
  double least = std::numeric_limits<double>::infinity();
  for ([[maybe_unused]] auto _ : state) {
    const auto start = Clock::now();
    for (int i = 0; i < calls; ++i) work();
    const std::chrono::duration<double, std::nano> taken = Clock::now() - start;
    least = std::min(least, taken.count() / calls);
  }
  state.counters["least"] = least / share;
}

void check_forces(benchmark::State& state, const Layout& layout, const SoftBody& body) {
  const auto plain = layouts().front().make(body);
  plain->evaluate();
  const VertexArray expected = plain->forces();
  const double error = (layout.forces().rows() - expected.rows()).norm();
  if (error > 1e-12 * expected.rows().norm()) {
    state.SkipWithError("the forces are wrong");
  }
}

void register_layouts(const std::vector<Shape>& all) {
  for (const NamedLayout& layout : layouts()) {
    for (const Shape& shape : all) {
      const auto run = [=](benchmark::State& state) {
        const SoftBody body = make_test_body(shape.mesh, true);
        const auto made = layout.make(body);
        measure(state, 1.0 * made->bodies() * body.positions.size(), [&] { made->evaluate(); });
        check_forces(state, *made, body);
      };
      benchmark::RegisterBenchmark(("layout/" + layout.name + "/" + shape.name).c_str(), run);
    }
  }
}

struct Method {
  std::string name;
  Integrator integrator;
  int evaluations;
};

void register_integrators(const std::vector<Shape>& all) {
  const std::vector<Method> methods = {{"rk4", Integrator::rk4, 4},
                                       {"velocity_verlet", Integrator::velocity_verlet, 2}};
  for (const Method& method : methods) {
    for (const bool dashpots : {true, false}) {
      for (const Shape& shape : all) {
        const auto run = [=](benchmark::State& state) {
          const SoftBody body = make_test_body(shape.mesh, dashpots);
          IntegratorScratch scratch(*body.mesh, method.integrator);
          const SoftAcceleration acceleration(*body.mesh, body.material, {0.0, 0.0, -9.81},
                                              scratch.acceleration);
          const SoftState start{body.positions, body.velocities};
          SoftState end = start;
          measure(state, 1.0 * method.evaluations * body.positions.size(), [&] {
            integrate(method.integrator, acceleration, 1.0 / 60.0, start, end.positions,
                      end.velocities, scratch);
          });
        };
        const std::string damping = dashpots ? "/dashpots/" : "/no_dashpots/";
        benchmark::RegisterBenchmark((method.name + damping + shape.name).c_str(), run);
      }
    }
  }
}

}  // namespace
}  // namespace pneuma::benchmarks

int main(int argc, char** argv) {
  using namespace pneuma::benchmarks;
  std::vector<Shape> all = shapes();
  register_integrators(all);
  for (Shape& shape : orders()) all.push_back(std::move(shape));
  register_layouts(all);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}

#include "app/check/model_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/record/statistics.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/topology.h"

namespace pneuma::app {
namespace {

using sim::at;
using sim::Triangle;
using sim::Vec3;

double angle(const Vec3& corner, const Vec3& a, const Vec3& b) {
  const Vec3 first = a - corner, second = b - corner;
  return std::atan2(first.cross(second).norm(), first.dot(second));
}

double smallest_angle(const sim::TriangleMesh& mesh) {
  double smallest = std::numbers::pi;
  for (const Triangle& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      smallest = std::min(
          smallest, angle(mesh.vertices[at(triangle[i])], mesh.vertices[at(triangle[(i + 1) % 3])],
                          mesh.vertices[at(triangle[(i + 2) % 3])]));
    }
  }
  return smallest * 180.0 / std::numbers::pi;
}

}  // namespace

ModelReport report_on(const assets::CleanModel& model) {
  const sim::MeshTopology topology(static_cast<int>(model.mesh.vertices.size()),
                                   model.mesh.triangles);
  const sim::VertexArray positions = sim::to_vertex_array(model.mesh.vertices);
  const assets::Component& kept = model.components[at(model.kept)];
  ModelReport report;
  report.vertices_before = model.vertices_before;
  report.vertices_welded = model.vertices_welded;
  report.vertices = topology.vertex_count();
  report.edges = topology.edge_count();
  report.triangles = topology.triangle_count();
  report.boundary_edges = kept.boundary_edges;
  report.non_manifold_edges = kept.non_manifold_edges;
  // Euler: V - E + F = 2 - 2 genus.
  report.genus = (2 - report.vertices + report.edges - report.triangles) / 2;
  report.volume = sim::volume(topology, positions);
  report.area = sim::surface_area(topology, positions);
  report.size = sim::bounds(positions).size();
  std::vector<double> lengths;
  for (const auto& [a, b] : topology.edges()) {
    lengths.push_back((model.mesh.vertices[at(a)] - model.mesh.vertices[at(b)]).norm());
  }
  const Spread edges = spread(std::move(lengths));
  report.edge_5th = edges.low;
  report.edge_median = edges.median;
  report.edge_95th = edges.high;
  report.smallest_angle = smallest_angle(model.mesh);
  report.springs_per_vertex = 2.0 * report.edges / report.vertices;
  report.fewest_springs = report.vertices;
  for (int v = 0; v < report.vertices; ++v) {
    const int springs = static_cast<int>(topology.ring(v).size());
    report.fewest_springs = std::min(report.fewest_springs, springs);
    if (springs <= report.most_springs) continue;
    report.most_springs = springs;
    report.most_springs_at = positions[v];
  }
  return report;
}

}  // namespace pneuma::app

#include "sim/soft/pressure_force.h"

#include <cmath>

#include "sim/mesh/measure.h"
#include "sim/mesh/vec4d.h"

namespace pneuma::sim {

void volume_gradient(const MeshTopology& topology, const VertexArray& positions,
                     VertexArray& gradient) {
  const VertexReader x(positions);
  const VertexWriter out(gradient);
  for (int v = 0; v < topology.vertex_count(); ++v) {
    // Differences from the vertex itself: the ring is closed, so any origin gives the same sum, and
    // this one keeps the digits of a body far away.
    const Vec4d centre = x[v];
    const auto ring = topology.ring(v);
    Vec4d previous = x[ring.back().vertex] - centre;
    Vec4d twice_area{};
    for (const auto& spoke : ring) {
      const Vec4d next = x[spoke.vertex] - centre;
      twice_area += cross(previous, next);
      previous = next;
    }
    out.put(v, twice_area / 6.0);
  }
}

double volume(const VertexArray& positions, const VertexArray& gradient) {
  const Vec3 centre = mean(positions);
  double three_volumes = 0.0;
  for (int v = 0; v < positions.size(); ++v) {
    three_volumes += (positions[v] - centre).dot(gradient[v]);
  }
  return three_volumes / 3.0;
}

double volume_rounding(const VertexArray& positions, const VertexArray& gradient) {
  constexpr double rounding = 1e-15;  // of a term and its part of the sum
  const Vec3 centre = mean(positions);
  double squared_distances = 0.0;
  for (int v = 0; v < positions.size(); ++v) {
    squared_distances += (positions[v] - centre).squaredNorm();
  }
  // The terms' sum is at most this (Cauchy and Schwarz).
  return rounding * std::sqrt(squared_distances * gradient.rows().squaredNorm());
}

}  // namespace pneuma::sim

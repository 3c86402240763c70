#include "sim/soft/pressure_force.h"

#include "sim/mesh/measure.h"

namespace pneuma::sim {

void volume_gradient(const MeshTopology& topology, const VertexArray& positions,
                     VertexArray& gradient) {
  for (int v = 0; v < topology.vertex_count(); ++v) {
    // Differences from the vertex itself: the ring is closed, so any origin gives the same sum, and
    // this one keeps the digits of a body far away.
    const Vec3 centre = positions[v];
    const auto ring = topology.ring(v);
    Vec3 previous = positions[ring.back().vertex] - centre;
    Vec3 twice_area = Vec3::Zero();
    for (const auto& spoke : ring) {
      const Vec3 next = positions[spoke.vertex] - centre;
      twice_area += previous.cross(next);
      previous = next;
    }
    gradient[v] = twice_area / 6.0;
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
  double terms = 0.0;
  for (int v = 0; v < positions.size(); ++v) {
    terms += (positions[v] - centre).norm() * gradient[v].norm();
  }
  return rounding * terms;
}

}  // namespace pneuma::sim

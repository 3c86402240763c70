// What its neighbours do to each vertex: springs and gas, gathered in one pass over its ring.
#pragma once

#include <span>

#include "sim/mesh/force_tables.h"
#include "sim/mesh/vertex_array.h"

namespace pneuma::sim {

/// Of every vertex, side by side since they are read together: the force of its springs in N, and
/// six times dV/dx, in m^2, as it comes from the ring.
class RingForces {
 public:
  explicit RingForces(int vertex_count) : rows_(2 * vertex_count) {}

  static constexpr int springs(int vertex) { return 2 * vertex; }
  static constexpr int six_volume_gradients(int vertex) { return 2 * vertex + 1; }

  /// Indexed by the above.
  VertexArray& rows() { return rows_; }
  const VertexArray& rows() const { return rows_; }

 private:
  VertexArray rows_;
};

/// Fills `forces` from the coefficients of spring_coefficients(). Both ends of an edge use the same
/// one: the two forces of a spring cancel exactly, and only their sums are rounded. The gradient is
/// that of volume_gradient() (pressure_force.h), to rounding. Returns the volume in m^3.
double gather_rings(const ForceTables& tables, const VertexArray& positions,
                    std::span<const double> coefficients, RingForces& forces);

}  // namespace pneuma::sim

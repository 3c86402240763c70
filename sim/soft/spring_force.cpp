#include "sim/soft/spring_force.h"

#include <cmath>

namespace pneuma::sim {

void spring_coefficients(const SoftMesh& mesh, const VertexArray& positions, double k,
                         std::span<double> coefficients) {
  const auto& edges = mesh.topology.edges();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    coefficients[e] = (positions[edges[e][1]] - positions[edges[e][0]]).squaredNorm();
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const double length = std::sqrt(coefficients[e]);
    const double s = k * (length - mesh.rest_lengths[e]) / length;
    coefficients[e] = length > 0.0 ? s : 0.0;
  }
}

double spring_energy(const SoftMesh& mesh, const VertexArray& positions, double k) {
  const auto& edges = mesh.topology.edges();
  double squares = 0.0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const double length = (positions[edges[e][1]] - positions[edges[e][0]]).norm();
    squares += std::pow(length - mesh.rest_lengths[e], 2);
  }
  return 0.5 * k * squares;
}

}  // namespace pneuma::sim

// The surface spring network (paper 3.1.1): every edge pulls its ends together with k (l - L).
#pragma once

#include <span>

#include "sim/soft/soft_mesh.h"

namespace pneuma::sim {

/// Writes per edge the coefficient s = k (l - L) / l in N/m, so that the force on end a is s (b -
/// a) and on end b its exact negative. An edge of no length has no direction, and s = 0.
void spring_coefficients(const SoftMesh& mesh, const VertexArray& positions, double k,
                         std::span<double> coefficients);

/// Sum over the edges of k (l - L)^2 / 2, in joule.
double spring_energy(const SoftMesh& mesh, const VertexArray& positions, double k);

}  // namespace pneuma::sim

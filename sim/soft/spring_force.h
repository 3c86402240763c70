// The surface spring network (paper 3.1.1): every edge pulls its ends together with k (l - L), and
// its dashpot (damping.h) with c times the rate at which they part.
#pragma once

#include <span>

#include "sim/mesh/soft_mesh.h"

namespace pneuma::sim {

/// The coefficient s in N/m with which spring and dashpot pull on the end a of an edge e = b - a
/// with s e, and on b with the exact negative:
///
///   s = k (l - L) / l  +  c (v_rel . e) / l^2,    l = |e|.
///
/// k > 0. An edge of no length has no direction: s is then some number, and the force zero.
double spring_coefficient(const Vec3& edge, const Vec3& relative_velocity, double rest_length,
                          double k, double dashpot);

/// The same for every edge of a mesh, fast.
void spring_coefficients(const SoftMesh& mesh, const VertexArray& positions,
                         const VertexArray& velocities, double k, double dashpot,
                         std::span<double> coefficients);

/// Sum over the edges of k (l - L)^2 / 2, in joule.
double spring_energy(const SoftMesh& mesh, const VertexArray& positions, double k);

}  // namespace pneuma::sim

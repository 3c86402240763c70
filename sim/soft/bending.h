// The bending of a soft body's surface: hinges between its triangles (sim/mesh/hinges.h), each of
// the energy K (1 - cos(t - t0)). Springs alone hold neither flat nor concave faces: there gas
// bends them without stretching them by more than the square of their slope.
#pragma once

#include <Eigen/Core>

#include "sim/mesh/soft_mesh.h"

namespace pneuma::sim {

/// Joule; 0 of a mesh without hinges. `rigidity`: of the plate, N m (SoftMaterial::bending).
double bending_energy(const SoftMesh& mesh, const VertexArray& positions, double rigidity);

/// Adds -dE/dx in N to the rows `stride` * vertex of `forces`.
void add_bending_forces(const SoftMesh& mesh, const VertexArray& positions, double rigidity,
                        int stride, VertexArray& forces);

/// d^2E/dx^2 of one hinge, N/m: of its vertices in the order of its corners.
using HingeHessian = Eigen::Matrix<double, 12, 12>;
HingeHessian hinge_hessian(const SoftMesh& mesh, const VertexArray& positions, double rigidity,
                           int edge);

/// The part of it that is left where the hinge is at its rest angle: g g^T with this g, sqrt(N/m).
Eigen::Matrix<double, 12, 1> hinge_stiffness_root(const SoftMesh& mesh,
                                                  const VertexArray& positions, double rigidity,
                                                  int edge);

}  // namespace pneuma::sim

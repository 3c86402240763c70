// The bending of a soft body's surface: hinges between its triangles (sim/mesh/hinges.h), each of
// the energy
//
//   K (1 - s1 s2 cos(t - t0)).
//
// Springs alone hold neither flat nor concave faces: there gas bends them without stretching them
// by more than the square of their slope.
//
// s1 and s2 are 1, but below 0.8 of a triangle's area at rest they fall with it to 0. With 1 there
// too, the angle of a triangle that loses its height and turns over would jump by pi, with forces
// as 1 / height: no step resolves that, however short, and what is missed is energy won.
//
// With a relaxation time tau a hinge is a Kelvin-Voigt one: its torque is
//
//   -K (s1 s2 sin(t - t0) + f tau dt/dt),    dt/dt = gradient of the angle times velocities.
//
// A motion of the frequency omega about the rest angle then dies away at the rate tau omega^2 / 2.
// f is 1, and falls to 0 between 0.9 and 0.8 of either triangle's area at rest. Energy is only
// taken, and no momentum: the gradient of an angle neither pushes nor turns a body as a whole.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/mesh/soft_mesh.h"

namespace pneuma::sim {

/// Joule; 0 of a mesh without hinges. `rigidity`: of the plate, N m (SoftMaterial::bending).
double bending_energy(const SoftMesh& mesh, const VertexArray& positions, double rigidity);
double bending_energy(const HingeTable& hinges, const VertexArray& positions, double rigidity);

/// Adds -dE/dx in N to the rows `stride` * vertex of `forces`.
void add_bending_forces(const HingeTable& hinges, const VertexArray& positions, double rigidity,
                        int stride, VertexArray& forces);

/// The same with dashpots. `relaxation_time`: tau, s (SoftMaterial::bending_damping).
void add_damped_bending_forces(const HingeTable& hinges, const VertexArray& positions,
                               const VertexArray& velocities, double rigidity,
                               double relaxation_time, int stride, VertexArray& forces);

/// d^2E/dx^2 of one hinge, N/m: of its vertices in the order of its corners.
using HingeHessian = Eigen::Matrix<double, 12, 12>;
HingeHessian hinge_hessian(const HingeTable& hinges, const VertexArray& positions, double rigidity,
                           int edge);

/// The part of it that is left where the hinge is at its rest angle: g g^T with this g, sqrt(N/m).
Eigen::Matrix<double, 12, 1> hinge_stiffness_root(const HingeTable& hinges,
                                                  const VertexArray& positions, double rigidity,
                                                  int edge);

/// What the dashpot of a hinge acts by.
struct HingeState {
  HingeAngle angle;               // t
  double dashpot_fraction = 0.0;  // f
};

/// Per edge.
void hinge_states(const HingeTable& hinges, const VertexArray& positions,
                  std::vector<HingeState>& states);

/// Sets weights and rest angles of `hinges` so that they act over a step from `start` as those at
/// rest with their dashpots do. `ratio`: tau over the step. A dashpot has the energy K f ratio (1 -
/// s1 s2 cos(t - t_start)), 0 at the start, where s1 s2 is 1 unless f is 0, and more elsewhere:
/// with the hinge it is again one hinge, whose step from there dissipates whatever its length, and
/// which leaves rigid rotations in peace.
void join_dashpots(const HingeTable& at_rest, const std::vector<HingeState>& start, double ratio,
                   HingeTable& hinges);

}  // namespace pneuma::sim

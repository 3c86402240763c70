// The implicit integrators (ERRATA row 32): every step is a minimisation, so that it cannot turn a
// body inside out.
//
// implicit_euler (backward Euler): x1 = x0 + h v1, m (v1 - v0) = h F(x1, v1). These are the
// equations of a stationary point, in x1 = x and with v1 = (x - x0) / h, of
//
//   E(x) = A/2 |x - y|^2 + k/2 sum (l - L)^2 + c/2h sum (l - l0)^2 - nRT ln V + friction,
//
//   A = m (1 + gamma h) / h^2,    y = x0 + (h v0 + h^2 g) / (1 + gamma h).
//
// The drag is linear, so it joins the inertia exactly. The dashpot of a spring acts on the rate at
// which its length l changes, (l - l0) / h over the step; taken so, and not along the spring's
// direction at the start, it is a function of the positions alone, dissipates whatever the step,
// and leaves rigid rotations in peace. With the spring it is again one spring, of stiffness k + c/h
// and rest length (k L + c/h l0) / (k + c/h). That of a hinge likewise acts by the angle that it
// had at the start (join_dashpots in bending.h), with the energy K tau / h (1 - s1 s2 cos(t -
// t_start)).
//
// sdirk2 (Alexander, Diagonally implicit Runge-Kutta methods for stiff ODEs, 1977): order 2, and
// for linear equations the same as TR-BDF2, but made of two implicit Euler steps alone: one of beta
// = (1 - 1/sqrt 2) h from the start (x0, v0), one of beta from (x0, v0) + (1 + sqrt 2) times what
// the first one changed. The dashpot's l0 and t_start are extrapolated likewise; the errors of
// first order that the rate (l - l0) / beta makes in either step then cancel over both.
//
// Ground (3.1.4): z >= 0 is a bound of the minimisation, and friction (Coulomb) a potential in it
// with the bound's own forces, so that neither can add energy. Restitution is the last act of a
// step. resolve_contacts sees these vertices at z = 0, at rest or on their way up from a rebound:
// what is left for it is what other bodies do to them.
//
// Guarantees, for every step and every material, up to rounding:
//   V > 0 afterwards, if it was before;
//   kinetic + spring + gas + gravity energy does not grow;
//   the momentum of a body that touches no ground changes by gravity and drag alone.
// The first is what the minimisation gives. From E(x1) <= E(x0), potential energy at x1 is at most
// the whole energy at x0; where springs are compressed E is not convex, and the kinetic energy
// v1 might be more than what is left: then it is cut to that, relative to the body's centre.
// sdirk2's extrapolation may break that inequality; such a step is done by implicit_euler instead.
// So is one in which a vertex hits the ground, since half of an impact cannot be extrapolated.
//
// `valence` weights the pressure so that it is no longer the gradient of an energy: not for these
// (require_energy). `literal` damping acts after a step and does not mind which.
#pragma once

#include <vector>

#include "sim/soft/euler_solver.h"
#include "sim/soft/soft_state.h"
#include "sim/world/settings.h"

namespace pneuma::sim {

/// Memory for a step on meshes of one shape; contents mean nothing between steps.
struct ImplicitScratch {
  /// Refers to the mesh, which must outlive it.
  explicit ImplicitScratch(const SoftMesh& mesh);

  EulerSolver solver;
  EulerBase start;  // about the body's centre, so that a body far away keeps its digits
  EulerBase extrapolated;
  VertexArray middle;  // m
  SoftState result;
  std::vector<char> pushed;  // per vertex: by the ground
};

/// How a step went.
struct ImplicitReport {
  double volume = 1.0;  // m^3 at its end; 1 without gas; see implicit_step
  int iterations = 0;
  int factorizations = 0;
  bool converged = true;
  bool by_euler = false;        // sdirk2 left it to implicit_euler
  bool energy_limited = false;  // velocities were cut
};

/// Writes the state one step of the settings after `start`, by their integrator, implicit_euler or
/// sdirk2. The material's pressure must be uniform. A start that has gas but no volume, or is not
/// finite, is left as it is, and its volume, or not a number, reported. Pinned vertices keep the
/// velocities that they start with; if some move, they do work, and the energy may grow.
ImplicitReport implicit_step(const SoftMesh& mesh, const SoftMaterial& material,
                             const Settings& settings, const SoftState& start,
                             VertexArray& positions, VertexArray& velocities,
                             ImplicitScratch& scratch, const Pins* pins = nullptr);

}  // namespace pneuma::sim

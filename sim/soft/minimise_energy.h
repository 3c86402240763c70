// Newton's method on a step's energy E (step_energy.h).
//
// Each iteration solves H p = -dE/dx and goes along p, by half of it, by a quarter, ... until V > 0
// and E has fallen by a share of what its slope promises (Armijo). H = S + q q^T, q = dV/dx
// sqrt(P/V), has a sparse part S and one of rank one. Conjugate gradients solve that nearly
// (conjugate_gradients.h); where they would take too long, the sparse factors of S do exactly, with
// the Sherman-Morrison formula for the rest. H is the exact second derivative as long as it is
// positive definite: as far as the conjugate gradients come to see, or by the signs of S = L D L^T.
// Either S is, or it has a single negative direction, that of blowing the body up, in which q q^T
// outweighs it (1 + q . S^-1 q < 0, by the determinant of S + q q^T). Where H is not, the inertia
// in it is raised until it is (Longva et al., Pitfalls of Projection, 2023, "Kinetic Newton").
//
// Newton iterations a step in the mean, and at most, of other choices, by new factors in each and
// before vertices stopped where friction has its kink, on 300 steps of 1/60 s of an 8 x 8 sphere on
// the ground:
//
//                                   as above   exact, else     springs and gas     gas's d^2V/dx^2
//                                              projected       always projected    left out
//   k = 150, n = 100, T = 4.4 K     3.1, 4     3.1, 4          5.9, 8              5.3, 7
//   k = 1e8, n = 1e4                1.1, 6     1.3, 6          51, 300             3.8, 300
//   at 1000 m/s against the ground  2.7, 71    4.0, 260        21, 300             13, 300
//   vertices displaced by 1.5 m,
//     k = 1e8, n = 1e6              3.4, 22    3.6, 86         296, 300            94, 300
//
// (Projected: negative eigenvalues of springs and of edges' terms of the gas set to zero.) As long
// as the iterations converge quickly they keep the factors of an earlier one, if there are any.
#pragma once

#include "sim/soft/conjugate_gradients.h"
#include "sim/soft/step_energy.h"
#include "sim/soft/vertex_matrix.h"

namespace pneuma::sim {

struct MinimiserReport {
  int iterations = 0;
  int factorizations = 0;
  bool converged = false;  // or stopped after greatest_iterations
};

/// Everything that is guaranteed holds after any number of iterations; so many are needed only by
/// crumpled bodies with k above 1e9 m / step^2.
inline constexpr int greatest_iterations = 200;

class EnergyMinimiser {
 public:
  /// Refers to the mesh, which must outlive it.
  explicit EnergyMinimiser(const SoftMesh& mesh);

  /// Where it starts: to be filled in and evaluated with V > 0, not below the floor. Where it ends:
  /// evaluated, with V > 0, not below the floor, and E no greater, up to rounding.
  EnergyPoint& point() { return point_; }
  const EnergyPoint& point() const { return point_; }

  /// Ends when the next iteration would move no vertex by more than `tolerance` (m), as far as can
  /// be told from how the last ones shrank, or when E no longer falls by more than rounding.
  MinimiserReport minimise(const StepEnergy& energy, double tolerance);

  /// Forgets the factors of the last minimisation, with which the next one otherwise begins, and
  /// whether it found conjugate gradients too slow: what comes out, to its last bit, depends on
  /// them.
  void forget() { has_factors_ = gradients_were_slow_ = false; }

  /// N, at point(): with which the floor holds a vertex up that is on it, else 0.
  double floor_force(const StepEnergy& energy, int vertex) const;
  /// N, at point(): with which a held vertex is held in its place across the ground.
  double hold_force(int vertex) const { return gradient_[vertex].head<2>().norm(); }
  /// To be called once before these.
  void update_gradient(const StepEnergy& energy);

 private:
  /// What of a vertex' coordinates does not move.
  struct Pins {
    bool height = false;  // on the floor, that pushes
    bool place = false;   // held by friction
    friend bool operator==(const Pins&, const Pins&) = default;
  };

  void find_pinned(const StepEnergy& energy);
  void clear_pinned(VertexArray& values) const;
  bool find_direction_by_old_factors(const StepEnergy& energy, double last_size);
  void find_direction(const StepEnergy& energy, MinimiserReport& report);
  void find_hessian(const StepEnergy& energy);
  void find_rank_one(const StepEnergy& energy);
  bool use_conjugate_gradients(const StepEnergy& energy) const;
  bool factorize(const StepEnergy& energy);
  bool solve(const StepEnergy& energy);
  void go(const StepEnergy& energy, double share);
  double descend(const StepEnergy& energy);

  const SoftMesh& mesh_;
  std::vector<std::array<int, 2>> opposite_;
  VertexMatrix matrix_;
  EnergyPoint point_;
  EnergyPoint trial_;
  VertexArray gradient_;        // of all of E
  VertexArray other_gradient_;  // without the gas
  VertexArray direction_;
  VertexArray rank_one_;         // q
  VertexArray rank_one_solved_;  // S^-1 q
  std::vector<Pins> pinned_;     // per vertex
  ConjugateGradients conjugate_gradients_;
  bool gradients_were_slow_ = false;
  bool is_stopped_ = false;  // a vertex in trial_: by the floor or by friction
  double added_inertia_ = 0.0;
  bool has_factors_ = false;  // in matrix_
  double factors_inertia_ = 0.0;
};

}  // namespace pneuma::sim

// Newton's method on a step's energy E (incremental_potential.h).
//
// Each iteration solves H p = -dE/dx and searches the line along p: all of it, half, a quarter, ...
// until V > 0 and E has fallen by a fraction of what its slope promises (Armijo). H = S + q q^T, q
// = dV/dx sqrt(P/V), has a sparse part S and one of rank one. Conjugate gradients solve that nearly
// (conjugate_gradients.h); where they would take too long, the sparse factors of S do exactly, with
// the Sherman-Morrison formula for the rest. H is the exact second derivative as long as it is
// positive definite: as far as the conjugate gradients come to see, or by the signs of S = L D L^T.
// Either S is, or it has a single negative direction, that of blowing the body up, in which q q^T
// outweighs it (1 + q . S^-1 q < 0, by the determinant of S + q q^T). Where H is not, its
// diagonal is shifted, which raises the inertia, until it is (Longva et al., Pitfalls of
// Projection, 2023, "Kinetic Newton").
//
// tests/benchmarks/README.md compares this Hessian with others. As long as the iterations converge
// quickly they keep the factors of an earlier one, if there are any.
#pragma once

#include "sim/soft/conjugate_gradients.h"
#include "sim/soft/incremental_potential.h"
#include "sim/soft/vertex_matrix.h"

namespace pneuma::sim {

struct MinimiserReport {
  int iterations = 0;
  int factorizations = 0;
  bool converged = false;  // or stopped after max_newton_iterations
};

/// Everything that is guaranteed holds after any number of iterations; so many are needed only by
/// crumpled bodies with k above 1e9 m / step^2.
inline constexpr int max_newton_iterations = 200;

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
  MinimiserReport minimise(const IncrementalPotential& energy, double tolerance);

  /// Forgets the factors of the last minimisation, with which the next one otherwise begins, and
  /// whether it found conjugate gradients too slow: what comes out, to its last bit, depends on
  /// them.
  void forget() { has_factors_ = gradients_were_slow_ = false; }

  /// N, at point(): with which the floor holds a vertex up that is on it, else 0.
  double floor_force(const IncrementalPotential& energy, int vertex) const;
  /// N, at point(): the friction with which an anchored vertex is held, across the ground.
  double anchor_force(int vertex) const { return gradient_[vertex].head<2>().norm(); }
  /// To be called once before these.
  void update_gradient(const IncrementalPotential& energy);

 private:
  /// Which of a vertex' coordinates are in the active set: they do not move.
  struct ActiveBounds {
    bool height = false;  // z: on the floor, which pushes, or pinned
    bool anchor = false;  // x and y: at the friction anchor, or pinned
    friend bool operator==(const ActiveBounds&, const ActiveBounds&) = default;
  };

  void find_active_set(const IncrementalPotential& energy);
  void clear_active(VertexArray& values) const;
  bool find_direction_by_old_factors(const IncrementalPotential& energy, double last_size);
  void find_direction(const IncrementalPotential& energy, MinimiserReport& report);
  void find_hessian(const IncrementalPotential& energy);
  void find_rank_one(const IncrementalPotential& energy);
  bool use_conjugate_gradients(const IncrementalPotential& energy) const;
  bool factorize(const IncrementalPotential& energy);
  bool solve(const IncrementalPotential& energy);
  void take_trial_step(const IncrementalPotential& energy, double fraction);
  double search_line(const IncrementalPotential& energy);

  const SoftMesh& mesh_;
  std::vector<std::array<int, 2>> opposite_;
  VertexMatrix matrix_;
  EnergyPoint point_;
  EnergyPoint trial_;
  VertexArray gradient_;        // of all of E
  VertexArray other_gradient_;  // without the gas
  VertexArray direction_;
  VertexArray rank_one_;                  // q
  VertexArray rank_one_solved_;           // S^-1 q
  std::vector<ActiveBounds> active_set_;  // per vertex
  ConjugateGradients conjugate_gradients_;
  bool gradients_were_slow_ = false;
  bool is_stopped_ = false;  // a vertex in trial_: by the floor or by friction
  double diagonal_shift_ = 0.0;
  bool has_factors_ = false;  // in matrix_
  double factors_inertia_ = 0.0;
};

}  // namespace pneuma::sim

// Friction and restitution of an implicit step as functions of positions.
//
// They take their normals and weights from where the step starts (Li et al., Incremental Potential
// Contact, 2020, section 5.4, "lagged"), and velocities from how far positions have moved since,
// u / h, along the normal and across it. Each is then the gradient of a function,
//
//   D(x) = sum of  (1 - e^2) (B(a) - B(a + h v_0 G(u_n / h v_0)))
//                  +  mu lambda_n h v_0 H(|u_t| / h v_0),
//
// G and H as in barrier.h, which is least where nothing moves: these terms only take energy.
// Friction is of the push at the start. What restitution takes is of the push where the pair is: B
// is its barrier, and a its distance at the start and h v_0 / 2 more, as G(q) >= q - 1/2. So it
// takes no more than the barrier gives there, and contacts do not pull. With the barrier, whose
// fraction e^2 is left, its sum along the normal is convex; alone it is not.
#pragma once

#include <vector>

#include "sim/potential/contact_potential.h"

namespace pneuma::sim {

/// A symmetric matrix K that acts between weighted sums of vertices: c_i K c_j.
struct WeightedBlock {
  std::array<int, 4> vertices{};
  int count = 4;
  PairWeights weights{};
  Mat3 block = Mat3::Zero();
};

class LaggedTerms {
 public:
  /// From the contacts at the `positions` from which a step of `step` (s) starts with `velocities`.
  /// `base`: the positions from which their ways count.
  void start(const std::vector<ActiveContact>& active, const VertexArray& positions,
             const VertexArray& velocities, const VertexArray& base, double step,
             double regularisation_speed);

  /// m: within ways of this length the forces turn.
  double length() const { return length_; }

  double energy(const VertexArray& positions) const;
  void add_gradient(const VertexArray& positions, VertexArray& gradient) const;
  /// Blocks, one for each term: of the second derivative, or positive semidefinite of parabolas
  /// that touch the terms and are nowhere below them, which hold on ways far longer than length()
  /// too.
  enum class Form { derivative, bounding };
  void append_hessian(const VertexArray& positions, Form form,
                      std::vector<WeightedBlock>& blocks) const;

 private:
  struct Term {
    std::array<int, 4> vertices{};
    int count = 4;
    PairWeights weights{};
    Vec3 normal = Vec3::Zero();
    Vec3 base = Vec3::Zero();  // weighted sum of the base positions, m
    double nearest = 0.0;      // a, m
    double reach = 0.0;        // m, of the barrier
    double strength = 0.0;     // (1 - e^2) of the barrier's, N
    double held = 0.0;         // (1 - e^2) B(a), J
    double braking = 0.0;      // mu lambda_n, N
  };

  Vec3 way(const Term& term, const VertexArray& positions) const;
  /// In J, by u_n in m, of what restitution takes.
  FunctionValue taken(const Term& term, double parting) const;
  /// N / m, of a parabola that bounds it.
  double bounding_curvature(const Term& term, double parting) const;

  std::vector<Term> terms_;
  double length_ = 1.0;  // h v_0, m
};

}  // namespace pneuma::sim

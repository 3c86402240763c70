// The impulse of one contact (paper 5.3) with Coulomb friction (3.1.4, ERRATA rows 6 and 29).
#pragma once

#include "sim/response/contact_side.h"

namespace pneuma::sim {

/// What a contact gave its first side so far in this step, N s. The second side got the opposite.
struct Impulse {
  double normal = 0.0;           // along the contact's normal, >= 0
  Vec3 friction = Vec3::Zero();  // across it, at most mu times the normal one
};

/// What friction has to move: the inverse of the mobility across the normal, kg, a symmetric matrix
/// that takes the normal to zero, and the smallest mass along any direction.
struct TangentMass {
  Mat3x4 matrix;
  double min;
};

class ContactImpulse {
 public:
  ContactImpulse() = default;  // for a list's memory
  /// `start_approach` (m/s): how fast the sides approached along the normal at the start of the
  /// step. They will part with restitution times that speed: of what forces add within the step
  /// nothing comes back, or bodies at rest would bounce for ever (ERRATA row 55).
  /// `work`: J, what all contacts of this pair of bodies, in this island, have added to their
  /// energy so far in the step; 0 at first. These contacts share it, and the caller keeps it for
  /// as long as this lives.
  ContactImpulse(World& world, std::span<const BoxMass> masses, const Contact& contact,
                 double start_approach, double& work);

  /// Warm start: applies an impulse that is likely to be near the result, instead of starting from
  /// none (ERRATA row 59). Called again, it adds to the first.
  void warm_start(const Vec3& impulse);

  /// One projected Gauss-Seidel update: corrects the impulse so that the sides no longer approach,
  /// after everything else that has happened to them so far: j = -v_rel . n / (1/m0 + 1/m1 + ...),
  /// and friction that stops the sliding with at most mu j. Called again and again, over all
  /// contacts of an island; j never becomes negative, also between boxes, which 5.3.3 does not ask
  /// for (ERRATA row 58). Returns the size of the correction: the sum of its components, N s.
  double correct();

  /// To be called once the sides no longer approach. From now on `correct` makes them part with
  /// restitution times the speed with which they met: with a single contact the total is the
  /// paper's j = -(1 + epsilon) v_rel . n / (1/m0 + 1/m1 + ...). What it gives back is at most the
  /// energy that the contacts of the two bodies have taken (ERRATA row 56), so that with friction
  /// and rotation too a restitution of 1 adds none (where several contacts share `work` nearly
  /// none: tests/benchmarks/README.md). Returns whether there is anything to give back.
  bool bounce();

  Impulse impulse() const { return {normal_impulse_, to_vec3(friction_impulse_)}; }
  Vec3 total() const { return to_vec3(normal_impulse_ * normal_ + friction_impulse_); }
  bool sticks() const { return sticks_; }  // friction is below its limit

  /// Moves the sides apart, in proportion to their inverse masses, until they have moved by the
  /// given fraction of the contact's depth since this was made (ERRATA rows 23, 60 to 62). Returns
  /// whether that moved anything.
  bool separate(double fraction) const;

 private:
  inline Vec4d relative_velocity() const { return first_.velocity() - second_.velocity(); }
  inline void apply(Vec4d impulse) const;
  inline double correct_normal(double parting);
  inline double max_without_gain(double parting) const;
  inline Vec4d correct_friction(Vec4d velocity, double normal);

  Vec4d normal_{};
  SolverSide first_;
  SolverSide second_;
  Mat3x4 mobility_{};        // of both sides, 1/kg: how an impulse changes the relative velocity
  Vec4d normal_response_{};  // 1/kg: what one N s along the normal adds to the relative velocity
  double normal_mobility_ = 0.0;  // 1/kg
  double normal_mass_ = 0.0;      // kg, its inverse
  TangentMass tangent_mass_{};
  Vec4d friction_response_{};  // tangent mass times that: the friction that cancels it
  double depth_ = 0.0;
  double start_distance_ = 0.0;  // m along the normal, first's position less second's, at first
  double friction_ = 0.0;        // Coulomb's mu
  double target_ = 0.0;          // m/s with which the sides part; negative: may still approach
  double bounce_speed_ = 0.0;    // m/s, the target once they have been stopped
  double* work_ = nullptr;       // J, shared
  double normal_impulse_ = 0.0;  // N s
  Vec4d friction_impulse_{};     // N s
  bool sticks_ = false;
};

}  // namespace pneuma::sim

// The impulse of one contact (paper 5.3) with Coulomb friction (3.1.4, ERRATA row 6).
#pragma once

#include "sim/response/contact_side.h"

namespace pneuma::sim {

/// What a contact gave its first side so far in this step, N s. The second side got the opposite.
struct Impulse {
  double normal = 0.0;           // along the contact's normal, >= 0
  Vec3 friction = Vec3::Zero();  // across it, at most mu times the normal one
};

/// m/s. A body that would part more slowly, and rise by less than 5 um, does not bounce: a stack
/// that always trembles a little rests better without.
inline constexpr double least_bounce_speed = 0.01;

/// What friction has to move: the inverse of the mobility across the normal, kg, a symmetric matrix
/// that takes the normal to zero, and the least mass along any direction.
struct TangentMass {
  RowMatrix matrix;
  double least;
};

class ContactImpulse {
 public:
  ContactImpulse() = default;  // for a place in a list
  /// `start_approach` (m/s): how fast the sides approached along the normal at the start of the
  /// step. They will part with the restitution's share of it: of what forces add within the step
  /// nothing comes back, or bodies at rest would bounce for ever.
  /// `work`: J, what all contacts of this pair of bodies, in this island, have added to their
  /// energy so far in the step; 0 at first, shared by them and kept by the caller for as long as
  /// this lives.
  ContactImpulse(World& world, std::span<const BoxMass> masses, const Contact& contact,
                 double start_approach, double& work);

  /// Starts from an impulse that is likely to be near the result, instead of from none. Called
  /// again, from the sum.
  void start_from(const Vec3& impulse);

  /// Corrects the impulse so that the sides no longer approach, with everything else that has
  /// happened to them so far: j = -v_rel . n / (1/m0 + 1/m1 + ...), and friction that stops the
  /// sliding with at most mu j. Called again and again, over all contacts of an island; j never
  /// becomes negative, also between boxes, which 5.3.3 leaves open. Returns the size of the
  /// correction: the sum of its components, N s.
  double correct();

  /// To be called once the sides no longer approach. From now on `correct` makes them part with the
  /// restitution's share of the speed with which they met: with a single contact the total is the
  /// paper's j = -(1 + epsilon) v_rel . n / (1/m0 + 1/m1 + ...). What it gives back is at most the
  /// energy that the contacts of the two bodies have taken, so that with friction and rotation too
  /// a restitution of 1 adds none (where several contacts share `work` nearly none: of 200,000
  /// sweeps over up to four random ones 33 added any, 1 % at most). Returns whether there is
  /// anything to give back.
  bool bounce();

  Impulse impulse() const { return {normal_impulse_, to_vec3(friction_impulse_)}; }
  Vec3 total() const { return to_vec3(normal_impulse_ * normal_ + friction_impulse_); }
  bool sticks() const { return sticks_; }  // friction is below its limit

  /// Moves the sides apart, shared by their inverse masses, until they have moved by `share` of
  /// the contact's depth since this was made. Returns whether that moved anything.
  bool separate(double share) const;

 private:
  inline Row relative_velocity() const { return first_.velocity() - second_.velocity(); }
  inline void apply(Row impulse) const;
  inline double correct_normal(double parting);
  inline double most_without_gain(double parting) const;
  inline Row correct_friction(Row velocity, double normal);

  Row normal_{};
  SideInContact first_;
  SideInContact second_;
  RowMatrix mobility_{};   // of both sides, 1/kg: how an impulse changes the relative velocity
  Row normal_response_{};  // 1/kg: what one N s along the normal adds to the relative velocity
  double normal_mobility_ = 0.0;  // 1/kg
  double normal_mass_ = 0.0;      // kg, its inverse
  TangentMass tangent_mass_{};
  Row friction_response_{};  // tangent mass times that: what friction needs to hold against it
  double depth_ = 0.0;
  double start_gap_ = 0.0;  // m along the normal, first's place less second's, when this was made
  double friction_ = 0.0;   // Coulomb's mu
  double target_ = 0.0;     // m/s with which the sides part; negative: may still approach
  double bounce_speed_ = 0.0;    // m/s, the target once they have been stopped
  double* work_ = nullptr;       // J, shared
  double normal_impulse_ = 0.0;  // N s
  Row friction_impulse_{};       // N s
  bool sticks_ = false;
};

}  // namespace pneuma::sim

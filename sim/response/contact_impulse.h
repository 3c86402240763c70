// The impulse of one contact (paper 5.3) with Coulomb friction (3.1.4, ERRATA row 6).
#pragma once

#include "sim/response/contact_side.h"

namespace pneuma::sim {

/// What a contact gave its first side so far in this step, N s. The second side got the opposite.
struct Impulse {
  double normal = 0.0;           // along the contact's normal, >= 0
  Vec3 friction = Vec3::Zero();  // across it, at most mu times the normal one
};

class ContactImpulse {
 public:
  /// `start_approach` (m/s): how fast the sides approached along the normal at the start of the
  /// step. They will part with the restitution's share of it: of what forces add within the step
  /// nothing comes back, or bodies at rest would bounce for ever.
  ContactImpulse(World& world, std::span<const BoxMass> masses, const Contact& contact,
                 double start_approach);

  /// Starts from an impulse that is likely to be near the result, instead of from none. Called
  /// again, from the sum.
  void start_from(const Vec3& impulse);

  /// Corrects the impulse so that the sides part as they should, with everything else that has
  /// happened to them so far: j = -(1 + epsilon) v_rel . n / (1/m0 + 1/m1 + ...), and friction that
  /// stops the sliding with at most mu j. In a first call on sides that are only approaching, the
  /// total is the paper's impulse; j never becomes negative. Returns the size of the correction, N
  /// s.
  ///
  /// Never adds kinetic energy in a first call for restitution <= 1: the normal part ends between
  /// the velocity it found and its mirror image, and the frictional part between sliding and not
  /// sliding.
  double correct();

  const Impulse& impulse() const { return impulse_; }
  Vec3 total() const { return impulse_.normal * normal_ + impulse_.friction; }
  bool sticks() const { return sticks_; }  // friction is below its limit

  /// Moves the sides apart, shared by their inverse masses, until they have moved by `share` of
  /// the contact's depth since this was made.
  void separate(double share) const;

 private:
  Vec3 relative_velocity() const { return first_.velocity() - second_.velocity(); }
  void apply(const Vec3& impulse) const;
  double correct_normal();
  double correct_friction();

  SideInContact first_;
  SideInContact second_;
  Vec3 normal_;
  double depth_;
  Vec3 start_gap_;  // first's place less second's when this was made
  std::array<Vec3, 2> tangents_;
  double normal_mass_;
  std::array<double, 2> tangent_masses_;
  double friction_;
  double target_ = 0.0;  // m/s with which the sides part; negative: may still approach
  Impulse impulse_;
  bool sticks_ = false;
};

}  // namespace pneuma::sim

// What an impulse meets on one side of a contact: one interface for soft features, rigid boxes and
// the ground, so that the impulse equation of section 5.3 is written once.
#pragma once

#include <array>
#include <span>

#include "sim/collision/contact.h"
#include "sim/world.h"

namespace pneuma::sim {

/// Of a box, what all its contacts of a step share.
struct BoxMass {
  double inverse_mass = 0.0;            // 1/kg
  Mat3 inverse_inertia = Mat3::Zero();  // world axes, 1/(kg m^2)
};
BoxMass box_mass(const RigidBox& box);

/// Refers to the world's bodies while a step is resolved. The ground is a side without a body.
class SideInContact {
 public:
  /// `masses` has one entry per box of the world.
  SideInContact(World& world, std::span<const BoxMass> masses, const ContactSide& side,
                const Vec3& point);

  /// Velocity in m/s of the side's material at the contact point. A soft feature's is the mean over
  /// its vertices, which have equal masses; a box's is v + omega x r (ERRATA row 19); the ground's
  /// zero.
  Vec3 velocity() const;

  /// The velocity in m/s that an impulse of one N s gives at the point, as a symmetric matrix: 1/m
  /// for a soft feature, m the sum of its vertices' masses (5.3.1); for a box
  /// n . K n = 1/m + n . ((I^-1 (r x n)) x r) (5.3.3); 0 for the ground.
  Mat3 mobility() const;

  /// 1/m without the rotational part: how displacements are shared between the sides.
  double inverse_mass() const { return inverse_mass_; }

  /// An impulse in N s. All vertices of a soft feature change alike.
  void apply(const Vec3& impulse) const;

  /// Of the soft feature the middle, of a box the centre, m: moves when the side is displaced.
  Vec3 place() const;
  void displace(const Vec3& displacement) const;

 private:
  SoftBody* soft_ = nullptr;
  RigidBox* box_ = nullptr;
  const Mat3* inverse_inertia_ = nullptr;
  std::array<int, 3> vertices_{};  // of the soft feature
  int vertex_count_ = 0;
  double inverse_mass_ = 0.0;
  Vec3 arm_ = Vec3::Zero();  // from the box's centre to the point
};

const Surface& surface(const World& world, const ContactSide& side);

/// Of two surfaces, the greater restitution and the geometric mean of the frictions.
Surface combine(const Surface& a, const Surface& b);

}  // namespace pneuma::sim

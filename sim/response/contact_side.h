// What an impulse meets on one side of a contact: one interface for soft features, rigid boxes and
// the ground, so that the impulse equation of section 5.3 is written once.
#pragma once

#include <array>
#include <span>

#include "sim/collision/contact.h"
#include "sim/mesh/row.h"
#include "sim/world.h"

namespace pneuma::sim {

/// Of a box, what all its contacts of a step share.
struct BoxMass {
  double inverse_mass = 0.0;    // 1/kg
  RowMatrix inverse_inertia{};  // world axes, 1/(kg m^2)
};
BoxMass box_mass(const RigidBox& box);

/// Refers to the world's bodies while a step is resolved. The ground is a side without a body.
/// Vectors are rows x y z 0. What the sweeps over the contacts call is inline.
class SideInContact {
 public:
  SideInContact() = default;
  /// `masses` has one entry per box of the world.
  SideInContact(World& world, std::span<const BoxMass> masses, const ContactSide& side,
                const Vec3& point);

  /// Velocity in m/s of the side's material at the contact point: of a box v + omega x r (ERRATA
  /// row 19), of a soft feature the mean over its vertices, which have equal masses; the ground's
  /// is zero.
  Row velocity() const {
    if (box_) return to_row(box_->velocity) + leverage_ * to_row(box_->angular_velocity);
    switch (vertex_count_) {
      case 1:
        return load_row(velocities_[0]);
      case 2:
        return (load_row(velocities_[0]) + load_row(velocities_[1])) * 0.5;
      case 3:
        return (load_row(velocities_[0]) + load_row(velocities_[1]) + load_row(velocities_[2])) *
               (1.0 / 3.0);
      default:
        return Row{};
    }
  }

  /// An impulse in N s. All vertices of a soft feature change alike.
  void apply(Row impulse) const {
    const Row change = inverse_mass_ * impulse;
    if (box_) {
      box_->velocity += to_vec3(change);
      box_->angular_velocity += to_vec3(turning_ * impulse);
      return;
    }
    for (int i = 0; i < vertex_count_; ++i) {
      store_row(load_row(velocities_[at(i)]) + change, velocities_[at(i)]);
    }
  }

  /// The velocity in m/s that an impulse of one N s gives at the point, as a symmetric matrix: 1/m
  /// for a soft feature, m the sum of its vertices' masses (5.3.1); for a box n . K n = 1/m +
  /// n . ((I^-1 (r x n)) x r) (5.3.3); 0 for the ground.
  RowMatrix mobility() const;

  /// 1/m without the rotational part: how displacements are shared between the sides.
  double inverse_mass() const { return inverse_mass_; }

  /// Whether an impulse also turns the side: only a box.
  bool turns() const { return box_ != nullptr; }

  /// Of the soft feature the middle, of a box the centre, m: moves when the side is displaced.
  Row place() const;
  void displace(Row displacement) const;

 private:
  SoftBody* soft_ = nullptr;
  RigidBox* box_ = nullptr;
  std::array<int, 3> vertices_{};        // of the soft feature
  std::array<double*, 3> velocities_{};  // theirs
  int vertex_count_ = 0;
  double inverse_mass_ = 0.0;
  // Of a box only, with r from its centre to the point. Kept because a contact waits for the one
  // before it, and products with matrices that are known are sooner done than r x and I^-1.
  RowMatrix leverage_{};  // columns e x r of each axis e: omega x r, times omega
  RowMatrix turning_{};   // columns I^-1 (r x e): what an impulse along each axis adds to omega
};

const Surface& surface(const World& world, const ContactSide& side);

/// Of two surfaces, the greater restitution and the geometric mean of the frictions.
Surface combine(const Surface& a, const Surface& b);

}  // namespace pneuma::sim

// What an impulse acts on at one side of a contact: one interface for soft features, rigid boxes
// and the ground, so that the impulse equation of section 5.3 is written once.
#pragma once

#include <array>
#include <span>

#include "sim/collision/contact.h"
#include "sim/mesh/vec4d.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// The mass of a box, computed once for all its contacts of a step.
struct BoxMass {
  double inverse_mass = 0.0;  // 1/kg
  Mat3x4 inverse_inertia{};   // world axes, 1/(kg m^2)
};
BoxMass box_mass(const RigidBox& box);

/// A ContactSide made ready for the solver: where that only names a body and its feature, this
/// refers to their velocities and knows their inverse masses while a step is resolved. The ground
/// is a side without a body. Vectors are rows x y z 0. What the Gauss-Seidel iterations call is
/// inline.
class SolverSide {
 public:
  SolverSide() = default;
  /// `masses` has one entry per box of the world.
  SolverSide(World& world, std::span<const BoxMass> masses, const ContactSide& side,
             const Vec3& point);

  /// Velocity in m/s of the side's material at the contact point: of a box v + omega x r (ERRATA
  /// row 19), of a soft feature the mean over its vertices, which have equal masses (ERRATA row
  /// 53); the ground's is zero.
  Vec4d velocity() const {
    if (box_) return to_vec4d(box_->velocity) + leverage_ * to_vec4d(box_->angular_velocity);
    switch (vertex_count_) {
      case 1:
        return load_vec4d(velocities_[0]);
      case 2:
        return (load_vec4d(velocities_[0]) + load_vec4d(velocities_[1])) * 0.5;
      case 3:
        return (load_vec4d(velocities_[0]) + load_vec4d(velocities_[1]) +
                load_vec4d(velocities_[2])) *
               (1.0 / 3.0);
      default:
        return Vec4d{};
    }
  }

  /// An impulse in N s. All vertices of a soft feature change alike (ERRATA rows 21 and 54).
  void apply(Vec4d impulse) const {
    const Vec4d change = inverse_mass_ * impulse;
    if (box_) {
      box_->velocity += to_vec3(change);
      box_->angular_velocity += to_vec3(turning_ * impulse);
      return;
    }
    for (double* const velocity : velocities_) {
      if (velocity == nullptr) break;
      store_vec4d(load_vec4d(velocity) + change, velocity);
    }
  }

  /// The velocity in m/s that an impulse of one N s gives at the point, as a symmetric matrix: 1/m
  /// for a soft feature, m the sum of its vertices' masses (5.3.1); for a box n . K n = 1/m +
  /// n . ((I^-1 (r x n)) x r) (5.3.3); 0 for the ground.
  Mat3x4 mobility() const;

  /// 1/m without the rotational part: in which proportion the sides are displaced.
  double inverse_mass() const { return inverse_mass_; }

  /// Whether an impulse also turns the side: only a box.
  bool turns() const { return box_ != nullptr; }

  /// The middle of the soft feature or the centre of the box, m: moves when the side is displaced.
  Vec4d position() const;
  void displace(Vec4d displacement) const;

 private:
  SoftBody* soft_ = nullptr;
  RigidBox* box_ = nullptr;
  std::array<int, 3> vertices_{};        // of the soft feature
  std::array<double*, 3> velocities_{};  // theirs; null where there is none
  int vertex_count_ = 0;
  double inverse_mass_ = 0.0;
  // Of a box only, with r from its centre to the point. Kept because a contact waits for the one
  // before it, and products with matrices that are known are sooner done than r x and I^-1.
  Mat3x4 leverage_{};  // columns e x r of each axis e: omega x r, times omega
  Mat3x4 turning_{};   // columns I^-1 (r x e): what an impulse along each axis adds to omega
};

const ContactMaterial& surface(const World& world, const ContactSide& side);

}  // namespace pneuma::sim

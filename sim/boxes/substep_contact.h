// What touches between two boxes, or a box and the ground, while they move in substeps.
//
// Up to four points share a normal n, from the second box to the first, and lie at r_i from the
// first box's centre, with which they move. With X from the second centre to the first, the
// relative velocity along n is
//   n.(v1 - v2) + (r_i x n).(w1 - w2) - (X x n).w2,
// so that one vector r_i x n a point serves both boxes, and impulses at common points keep angular
// momentum wherever the boxes have moved since. The points are solved for by a few iterations
// within their own 4 x 4 matrix, and their impulses are given together. Friction acts at one point
// amid them, and turns about n by what presses times its distance from there, as in box3d.
#pragma once

#include <array>

#include "sim/collision/box_contact.h"
#include "sim/mesh/vec4d.h"
#include "sim/world/contact_material.h"

namespace pneuma::sim {

/// A box in substeps.
struct SubstepBox {
  Vec4d velocity{};           // m/s
  Vec4d angular_velocity{};   // rad/s
  Vec4d moved{};              // m, since the contacts were found
  Vec4d turned{};             // rad
  Mat3x4 inverse_inertia{};   // world axes, 1/(kg m^2)
  Vec4d centre{};             // m, where the contacts were found
  double inverse_mass = 0.0;  // 1/kg; 0: nothing changes its velocities

  bool is_driven() const { return inverse_mass == 0.0; }
};

/// A contact as a damped spring, in a form that no step is too long for (Catto 2011, "Soft
/// constraints"; box3d).
struct Softness {
  double rate = 0.0;           // 1/s, at which boxes part that are too near
  double mass_scale = 1.0;     // of the effective mass
  double impulse_scale = 0.0;  // of the impulse so far, which is given back
};
/// Of this frequency (Hz) and damping ratio, in substeps of `step` s.
Softness soft_spring(double frequency, double damping_ratio, double step);

class SubstepContact {
 public:
  static constexpr std::size_t max_points = 4;

  /// Between the boxes of these numbers, `a` and `b`, which keep a gap (m). They bounce if they
  /// meet faster than `min_bounce` (m/s).
  SubstepContact(int first, int second, const SubstepBox& a, const SubstepBox& b,
                 const BoxContact& contact, double gap, const ContactMaterial& material,
                 double min_bounce);

  int first() const { return first_; }
  int second() const { return second_; }
  std::size_t count() const { return count_; }
  bool presses() const { return sum_of_lanes(impulse_) > 0.0; }
  Vec3 normal() const { return to_vec3(normal_); }
  /// From the first box's centre, m.
  Vec3 arm(std::size_t point) const { return arms_[point]; }

  /// N s on the first box at each point in a substep, friction included.
  using Impulses = std::array<Vec3, max_points>;
  Impulses impulses() const;
  void start_from(const Impulses& impulses);

  /// Gives the impulses of the last substep, as a first guess.
  void warm_start(SubstepBox& a, SubstepBox& b) const;
  /// Keeps the boxes, for `step` s, from coming nearer than the gap; those that are nearer it moves
  /// apart. Returns by how much a velocity along the normal was changed, m/s.
  double push(SubstepBox& a, SubstepBox& b, const Softness& softness, double step);
  /// J, of what has parted boxes that were too near since they were pushed.
  double parting_work(const SubstepBox& a, const SubstepBox& b, double step) const;
  /// Takes back the velocity that only pushed the boxes apart, and lets them rub. Returns as `push`
  /// does.
  double relax(SubstepBox& a, SubstepBox& b, double step);
  void bounce(SubstepBox& a, SubstepBox& b);

  /// J of this substep, from the box that nothing changes, if one is such, to the other.
  double driven_work(const SubstepBox& a, const SubstepBox& b) const;

 private:
  struct Push;
  Vec4d offset_normal(const SubstepBox& a, const SubstepBox& b) const;
  Vec4d along_normal(Vec4d of_first, Vec4d turn_of_first, Vec4d of_second, Vec4d turn_of_second,
                     Vec4d offset_normal) const;
  void give(SubstepBox& a, SubstepBox& b, Vec4d impulses, Vec4d offset_normal) const;
  void give_at_centre(SubstepBox& a, SubstepBox& b, Vec4d impulse) const;
  void twist(SubstepBox& a, SubstepBox& b, double moment) const;
  double solve(SubstepBox& a, SubstepBox& b, const Push& push);
  void rub(SubstepBox& a, SubstepBox& b);
  void find_normal_mass(const SubstepBox& a, const SubstepBox& b);
  void find_centre_of_friction();
  void find_friction_mass(const SubstepBox& a, const SubstepBox& b);

  Vec4d normal_{};
  Vec4d offset_{};                            // X, m
  Vec4d turns_x_{}, turns_y_{}, turns_z_{};   // r_i x n, m
  std::array<Vec4d, max_points> mobility_{};  // 1/kg: columns of the matrix of the points
  Vec4d alone_{}, mass_{};                    // 1/kg and kg, of each point alone; 0: there is none
  Vec4d distance_{};                          // m beyond the gap, when the contact was found
  Vec4d pushed_distance_{};                   // m, when it was last pushed
  Vec4d impulse_{};                           // N s, along the normal
  Vec4d greatest_impulse_{};                  // N s, of all substeps
  Vec4d approach_{};                          // m/s, of what meets fast enough to bounce
  Vec4d lever_{};                             // m, from where friction acts
  Vec4d centre_{};                            // there, from the first box's centre, m
  Vec4d tangent_{}, other_tangent_{};         // unit, across the normal
  Vec4d friction_impulse_{};                  // N s
  double mass_xx_ = 0.0, mass_xy_ = 0.0, mass_yy_ = 0.0;  // kg, across the normal
  double twist_mass_ = 0.0;                               // kg m^2
  double twist_impulse_ = 0.0;                            // N s m, about the normal
  double friction_ = 0.0;
  double restitution_ = 0.0;
  int first_ = 0;
  int second_ = 0;
  std::size_t count_ = 0;
  bool bounces_ = false;
  std::array<Vec3, max_points> arms_;  // r_i, m
};

}  // namespace pneuma::sim

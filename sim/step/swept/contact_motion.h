// What the sides of a swept contact are and do in a step. Private to sim/step.
#pragma once

#include <utility>

#include "sim/step/swept/swept_contact.h"

namespace pneuma::sim {

class ContactMotion {
 public:
  /// Features that are nearer than the distance wanted by this factor are in contact.
  static constexpr double near_of_wanted = 1.5;

  /// Refers to all of them. `start`: what the step starts from.
  ContactMotion(const World& world, const MotionStart& start, SweptBodies& bodies)
      : world_(world), start_(start), bodies_(bodies) {}

  /// m, that two bodies keep between their surfaces.
  double distance_wanted(int first, int second) const;
  /// m, up to which features of two bodies are in contact.
  double near_distance(int first, int second) const;
  /// The same of two bodies that keep a distance `wanted` (m).
  static double near_distance(double wanted);

  ContactMaterial material(const SweptContact& contact) const;
  /// Boxes, and boxes and the ground: what rests on each other stays there.
  bool is_rigid(const SweptContact& contact) const;
  /// Whether one of its sides is moved as its keys say.
  bool is_driven(const SweptContact& contact) const;
  /// Whether an impulse moves a side of it: pinned vertices do not.
  bool is_moved(const SweptContact& contact) const;

  /// Of the first side against the second, m.
  Vec3 displacement(const SweptContact& contact) const;
  /// The part of it by which boxes were moved apart, m.
  Vec3 shift(const SweptContact& contact) const;
  /// m/s, where impulses act.
  Vec3 start_velocity(const SweptContact& contact) const;
  Vec3 end_velocity(const SweptContact& contact) const;
  /// m/s, where impulses act: of the second side if it is moved, less that of the first if
  /// that one is.
  Vec3 driven_velocity(const SweptContact& contact, Moment moment) const;
  /// Sets the contact's approach and drift: how the sides meet. `kicked`: m/s, by impulses since
  /// the start.
  void find_approach(SweptContact& contact, const Vec3& kicked) const;

  SweptImpulse impulse(const SweptContact& contact, double friction) const;

 private:
  const ContactMaterial& material(int body) const;
  bool is_driven(const SurfacePoint& side) const;
  std::pair<SurfacePoint, SurfacePoint> where_impulses_act(const SweptContact& contact) const;

  const World& world_;
  const MotionStart& start_;
  SweptBodies& bodies_;
};

}  // namespace pneuma::sim

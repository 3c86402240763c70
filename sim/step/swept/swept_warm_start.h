// What the last step knew of contacts: what held bodies, from which the solver of this one starts
// (ERRATA row 59), and how far what friction holds has slipped (row 67).
// Private to sim/step.
#pragma once

#include <span>

#include "sim/step/swept/contact_motion.h"
#include "sim/step/swept/swept_memory.h"

namespace pneuma::sim {

class SweptWarmStart {
 public:
  /// Refers to all of them. `start`: what the step starts from.
  SweptWarmStart(World& world, const MotionStart& start, SweptMemory& memory)
      : world_(world), start_(start), m_(memory), motion_(world, start, memory.bodies) {}

  /// Gives each impulse that held a point of a box at this moment of the last step to the nearest
  /// contact of the same boxes, and what held features of a soft body to the contact of the same
  /// features: of a part of a step this `fraction`. The contacts are in the order of their bodies.
  void apply(Moment moment, double fraction);
  /// Keeps what holds bodies at both moments, once the end is solved for, for the next step; and of
  /// those that sleep what held them when they fell asleep.
  void remember(double fraction);

  /// m, by which the sides of a contact have slipped, across its normal: until the step began, or
  /// until its end once they are remembered.
  Vec3 slip(const SweptContact& contact) const;
  /// Keeps how far the contacts of the start, once solved for, have slipped that a soft body sticks
  /// in, or in which a box was held by what is moved; and of bodies that sleep what they had
  /// slipped when they fell asleep.
  void remember_slips();
  /// Of these, and of the contacts of the end, once solved for to a `tolerance` (m/s): keeps those
  /// of boxes that are held by what is moved.
  void remember_held_boxes(double tolerance);

 private:
  void apply_to_boxes(Moment moment, double fraction);
  void apply_to_features(Moment moment, double fraction);
  /// Or of a box and the ground.
  bool is_of_boxes(const SweptContact& contact) const;
  static FeatureImpulse make_feature_impulse(const SweptContact& contact, Moment moment,
                                             const Vec3& impulse);
  /// The impulse of the nearest contact, if there is one.
  SweptImpulse* find(const WarmStartImpulse& kept, Moment moment);
  void remember(std::span<const SweptContact> contacts, std::span<const SweptImpulse> impulses,
                Moment moment, double fraction);
  void find_stopped_islands();
  bool is_stopped(const SweptContact& contact);
  void remember_of_boxes(const SweptContact& contact, Moment moment, const Vec3& impulse);
  FrictionSlip* find_slip(const SweptContact& contact) const;
  Vec3 turned(const SweptContact& contact, const Vec3& slip) const;
  void keep(std::vector<FrictionSlip>& slips);
  static void add_slip(const SweptContact& contact, const Vec3& slip,
                       std::vector<FrictionSlip>& slips);
  bool slides(const SweptContact& contact, const SweptImpulse& impulse) const;
  bool sleeps(int first, int second) const;
  RigidState state(int box, Moment moment) const;

  World& world_;
  const MotionStart& start_;
  SweptMemory& m_;
  ContactMotion motion_;
  std::size_t first_of_pair_ = 0;  // contact of the pair that was last looked for
};

/// Of a world whose bodies were others in the step before, nothing is known.
void forget_other_bodies(World& world);

}  // namespace pneuma::sim

// Where the features of a candidate make a contact. Private to sim/step.
#pragma once

#include <optional>

#include "sim/collision/box_contact.h"
#include "sim/step/swept/contact_motion.h"

namespace pneuma::sim {

/// Of a skin: points of boxes that are no further from being hit than others are hit as well.
inline constexpr double hit_together = 0.5;
/// m. At less than this the direction between two points is rounding.
inline constexpr double rounding_distance = 1e-9;

class ContactPlaces {
 public:
  /// Refers to all of them. `start`: what the step starts from.
  ContactPlaces(const World& world, const MotionStart& start, SweptBodies& bodies)
      : world_(world), start_(start), bodies_(bodies), motion_(world, start, bodies) {}

  OrientedBox start_box(int body) const;
  OrientedBox end_box(int body) const;

  /// At the start: unit, from the second to the first; and m.
  Vec3 start_normal(const SweptCandidate& candidate) const;
  double start_distance(const SweptCandidate& candidate) const;
  /// Of features that are nearest to each other in these points at the moment.
  SweptContact place(const SweptCandidate& candidate, const ClosestPoints& closest,
                     Moment moment) const;
  SweptContact place_on_ground(const SweptCandidate& candidate, Moment moment) const;
  /// Whether no other features that these are parts of stand for them.
  bool stands(const SweptCandidate& candidate, const ClosestPoints& closest, Moment moment) const;
  /// The same where they meet, after a fraction of the step; and of a box from outside of it.
  bool stands_where_it_meets(const SweptCandidate& candidate, double fraction) const;
  /// A soft body that gives way, and a box that stands still.
  bool are_soft_and_still_box(const BodyPair& bodies) const;
  /// Whether the soft side of a contact lies over what joins the box at the edge or corner that
  /// takes part: another box that stands still, or the ground.
  bool is_over_flush_box(const SweptCandidate& candidate, const ClosestPoints& closest) const;
  /// m, of a soft feature at the start over the box that stands still, and over others beside it.
  double height_over_still_boxes(const SweptCandidate& candidate) const;
  /// Whether the sides keep their shapes and these features are beside each other, not on each
  /// other: what slides from one face onto the next meets the edge between them nowhere.
  bool are_beside_each_other(const SweptCandidate& candidate, const ClosestPoints& closest,
                             Moment moment) const;
  /// Of features that meet after a fraction of the step, at its start.
  SweptContact place_at(const SweptCandidate& candidate, double fraction) const;
  /// The same, so that its impulse keeps angular momentum.
  SweptContact place_along_line(const SweptCandidate& candidate, double fraction) const;
  /// A contact at the start of the step that keeps two boxes apart where they would be in each
  /// other at its end, along the `normal` that they have there.
  SweptContact place_before_end(const SweptCandidate& candidate, const Vec3& normal,
                                const BoxContactPoint& point) const;
  /// The points of near boxes go with them, and their normal is that of the start.
  SweptContact move_to_end(const SweptCandidate& candidate) const;
  /// Where the features of a candidate are nearest at the end, if they are in contact then or have
  /// `acted` on each other at the start (else null). None if another pair stands for it, or if
  /// nothing says where they would part.
  std::optional<SweptContact> place_at_end(const SweptCandidate& candidate,
                                           const SweptContact* acted) const;
  /// Of two boxes, or of one and the ground: where the features are nearest at the end, if they
  /// are not in contact but so little further apart that they are hit together with others.
  std::optional<SweptContact> place_beside_hit(const SweptCandidate& candidate) const;

 private:
  bool stands(const SweptCandidate& candidate, const ClosestPoints& closest, double fraction) const;
  bool is_in_still_box(const SweptCandidate& candidate, const ClosestPoints& closest) const;
  bool obstacle_is_nearest(const SweptCandidate& candidate, const ClosestPoints& closest,
                           double fraction, double sine_of_flat) const;
  bool boxes_are_beside(const SweptCandidate& candidate, const ClosestPoints& closest,
                        Moment moment) const;
  bool vertices_are_beside(const SweptCandidate& candidate, const ClosestPoints& closest,
                           Moment moment) const;
  bool passes_rim(const SweptCandidate& candidate, const ClosestPoints& closest,
                  Moment moment) const;
  Vec3 normal_of(const SweptCandidate& candidate, const ClosestPoints& closest,
                 Moment moment) const;
  std::optional<SweptContact> place_at_end(const SweptCandidate& candidate,
                                           const SweptContact* acted, double reach) const;
  bool has_slid_off(const SweptCandidate& candidate, const ClosestPoints& closest,
                    const SweptContact& contact) const;

  const World& world_;
  const MotionStart& start_;
  SweptBodies& bodies_;
  ContactMotion motion_;
};

}  // namespace pneuma::sim

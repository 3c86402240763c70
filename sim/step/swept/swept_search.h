// Swept contacts: found among all features whose ways come near each other. Private to sim/step.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sim/collision/oriented_box.h"
#include "sim/step/swept/contact_places.h"
#include "sim/step/swept/swept_memory.h"

namespace pneuma::sim {

/// Appends the contacts that pressed, for those who ask the stepper.
void list_pressing(const SweptMemory& memory, std::vector<Contact>& contacts);

/// Finds the contacts of one step of a world: fills the memory's contacts and impulses.
class SweptSearch {
 public:
  /// Refers to all of them. `start`: what the step starts from.
  SweptSearch(const World& world, const MotionStart& start, SweptMemory& memory)
      : world_(world),
        start_(start),
        m_(memory),
        bodies_(memory.bodies),
        motion_(world, start, memory.bodies),
        places_(world, start, memory.bodies) {}

  const ContactMotion& motion() const { return motion_; }
  /// What may meet.
  void find_candidates();
  /// Whether a vertex of a soft body meets the ground by itself: within the body's allowance,
  /// nothing can touch what has a part in no candidate. Of the candidates as last marked.
  bool is_alone(int soft, int vertex) const {
    return m_.on_ground[at(soft)].meets_alone &&
           !m_.is_in_candidate[at(bodies_.node_of(soft, vertex))];
  }
  /// Of the candidates as they are now.
  void mark_candidates();
  /// Which boxes touch, at the start of the step, what does not fall: the ground, soft bodies or
  /// what stands still or is moved, directly or through other boxes; but those that touch nothing
  /// but the ground and what stands still are not among them (ERRATA row 36).
  void find_borne_boxes();
  /// Fills the memory's `between_walls`: the axes of free boxes along which what is static or
  /// moved, or the ground, is on both sides, and leaves less room than the distance up to which
  /// boxes are in contact. That is so or not wherever between them the box is.
  void find_boxes_between_walls();
  /// The bodies now end elsewhere: what may meet, if that is too far from what was searched for.
  void follow_ends();
  /// The contacts that the free motion would use up.
  void start();
  /// m, that near boxes, or a box and an obstacle or the ground, lack at most of the distance that
  /// shifts keep.
  double greatest_missing_of_boxes() const;
  /// Fills the memory's contacts with those that keep boxes from being shifted into each other,
  /// into obstacles or into the ground: where there is no more than this `room` (m) between them.
  void find_contacts_of_boxes(double room);
  /// Adds to these what keeps boxes from being shifted, by `reach` (m) at most, into soft bodies.
  void find_contacts_beside_boxes(double reach);
  /// Adds to the contacts what bodies would pass through on their ways as they came out. Whether
  /// there is any.
  bool find_collisions();
  /// Marks the contacts that have stopped a box on its way, which then turned away from what it
  /// came to: the end of the step would take their impulses back, as it is not near that then.
  /// Returns whether there are any.
  bool find_missed();
  /// Of these what must not be; boxes may lie in each other for a while.
  const std::optional<BodyPair>& blocked() const { return blocked_; }

 private:
  void search_beside_obstacles();
  bool is_beside_obstacle(const BodyPair& bodies) const;
  NearTriangles& next_near_triangles();
  void offer_beside_obstacle(const BodyPair& bodies, NearTriangles& near);
  void offer_beside_obstacle(const BodyPair& bodies, const NearFeatures& features);
  bool obstacle_is_nearest(const BodyPair& bodies, const NearFeatures& features,
                           const ClosestPoints& closest) const;
  void wake_if_touched(const BodyPair& bodies);
  bool touches(const SweptCandidate& candidate) const;
  void search_ways();
  bool keep_earlier(const BodyPair& bodies);
  bool is_kept(const BodyPair& bodies) const;
  void find_near_ground();
  bool may_touch(const BodyPair& bodies) const;
  bool offer_near_boxes(const BodyPair& bodies);
  bool stay_apart(const BodyPair& bodies, const OrientedBox& one, const OrientedBox& other) const;
  /// `visit(candidate, missing)` of near boxes, and of boxes and the ground: with what they lack of
  /// the distance that shifts keep, m.
  template <class Visit>
  void for_each_of_boxes(const Visit& visit) const;
  bool slide_past_each_other(const BodyPair& bodies) const;
  bool turn_into_each_other(SweptCandidate& first_point);
  std::optional<double> kept_between_walls(const SweptCandidate& candidate, double wanted) const;
  bool is_squeezed(const SweptCandidate& candidate) const;
  void release_what_is_driven_into_others();
  bool find_walls_beside();
  void find_walls_beyond_rows();
  double middle_distance(const SweptCandidate& candidate) const;
  bool squeeze(const WallBeside& below, const WallBeside& above, const Vec3& axis,
               const Vec3& middle) const;
  bool hold(const WallBeside& below, const WallBeside& above, const RigidBox& box) const;
  double greatest_relative_way(int first, int second) const;
  void offer_near_features(const BodyPair& bodies);
  /// Gives the contacts that there are to the candidates of another search.
  void recall_contacts();
  void list_recalled();
  void put_back_missing();
  SweptCandidate missing_candidate(const RecalledContact& recalled) const;
  bool find_collisions_of_pair(std::span<SweptCandidate> candidates);
  void find_first_meetings();
  std::optional<double> fraction_of_meeting(const SweptCandidate& candidate) const;
  int box_beside_still(const BodyPair& bodies) const;
  bool comes_later(const SweptCandidate& candidate, double fraction) const;
  bool meets(SweptCandidate& candidate);
  void hold_where_they_meet();
  bool sinks_in(SweptCandidate& candidate);
  bool goes_into_ground(SweptCandidate& candidate);
  bool is_seen_on_its_way(const SweptCandidate& candidate) const;
  bool add_if_it_meets(SweptCandidate& candidate);
  void add(SweptCandidate& candidate, SweptContact contact);

  const World& world_;
  const MotionStart& start_;
  SweptMemory& m_;
  SweptBodies& bodies_;
  ContactMotion motion_;
  ContactPlaces places_;
  std::optional<BodyPair> blocked_;
  bool has_started_ = false;           // the contacts of the start are found
  bool has_looked_ = false;            // for collisions
  bool are_beside_obstacles_ = false;  // any candidates
  std::size_t next_earlier_ = 0;       // of the candidates of the search before
  std::size_t next_near_ = 0;          // of the near triangles
};

}  // namespace pneuma::sim

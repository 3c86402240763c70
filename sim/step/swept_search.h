// Swept contacts: found among all features whose ways come near each other. Private to sim/step.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sim/base/disjoint_sets.h"
#include "sim/collision/box_contact.h"
#include "sim/collision/oriented_box.h"
#include "sim/response/carried_boxes.h"
#include "sim/response/fall_asleep.h"
#include "sim/step/swept_solver.h"
#include "sim/swept/impact_path.h"

namespace pneuma::sim {

/// Of a skin: points of boxes that are no further from being hit than others are hit as well.
inline constexpr double hit_together = 0.5;

/// What a step or a part of it began with, that has failed and is to be halved.
struct SweptStart {
  MotionStart motion;
  std::vector<WarmStartImpulse> warm_start_impulses;
  std::vector<FrictionSlip> friction_slips;
  std::vector<double> lost_energy;  // J
};

/// How often a step may be halved: to a 256th.
inline constexpr int max_halvings = 8;

/// Memory of limit_returned_energy.
struct ReturnedEnergyMemory {
  std::vector<std::uint8_t> returns;  // per island
  std::vector<Vec3> given;            // N s, per contact
};

/// Boxes that are near each other, directly or through others.
struct NearGroups {
  explicit NearGroups(std::size_t boxes) : sets(boxes + 1) { order.reserve(boxes); }

  base::DisjointSets sets;  // of the boxes, and of one more for all that does not give way
  std::vector<int> order;   // the boxes that are near nothing else, set by set
};

/// Of a soft body and an obstacle.
struct NearTriangles {
  std::vector<TrianglePair> triangles;
  bool is_known = false;  // of the last search for what is near
};

/// Contacts of the same features, when another search has other candidates.
struct RecalledContact {
  int first = 0;
  int last = 0;
  bool is_found = false;  // by the other search
};

/// Features that come too near each other on their ways.
struct Meeting {
  int candidate = 0;
  double fraction = 0.0;  // of the step
};

/// A point in which boxes that met nothing else have met within the step (free_impacts.h).
struct MetFreely {
  int first = 0;
  int second = 0;
  Vec3 point = Vec3::Zero();    // m
  Vec3 normal = Vec3::Zero();   // unit, from the second to the first
  Vec3 impulse = Vec3::Zero();  // N s, on the first
};

/// Of a soft body: its vertices that have a part in no candidate and meet the ground by themselves.
struct OnGround {
  bool meets_alone = false;  // it has such vertices
  bool is_held = false;      // one of them has met the ground
  double work = 0.0;         // J, of the ground on these
};

/// A vertex that has a part in a candidate and ends below the ground.
struct SunkVertex {
  int node = 0;
  int soft = 0;
  int vertex = 0;
  double room = 0.0;  // m, by which it may rise
};

/// What a box that moves freely has contacts with at the start of the step.
struct Partner {
  int contacts = 0;
  std::size_t first_contact = 0;
  int body = swept_ground;   // of the last of them
  bool is_only_one = false;  // of all of them, and not near yet
  bool is_hit = false;       // in one of them it may be, and bounce
};

struct SweptMemory {
  explicit SweptMemory(const World& world)
      : bodies(world),
        solver(bodies),
        starts(max_halvings + 1),
        near_groups(world.rigid.size()),
        carried_boxes(world),
        fall_asleep(world),
        on_ground(world.soft.size()),
        is_in_candidate(at(bodies.node_count())) {
    members.reserve(at(bodies.count()));
    parts_done.reserve(1u << max_halvings);
  }

  SweptBodies bodies;
  SweptSolver solver;
  std::vector<SweptStart> starts;  // by how often the step has been halved
  std::vector<double> parts_done;  // of a step that is halved, fractions of it
  std::vector<BodyPair> near_bodies;
  std::vector<SweptCandidate> candidates;
  std::vector<SweptCandidate> earlier_candidates;  // of the search before, in the same step
  ObstacleSearch obstacle_search;
  std::vector<NearTriangles> near_triangles;  // of each soft body and obstacle that are near
  std::vector<int> touched_asleep;  // bodies that sleep and that something awake may touch
  std::vector<NearFeatures> found;  // of two bodies
  std::vector<SweptContact> contacts;
  std::vector<SweptImpulse> impulses;        // of the contacts, one each
  std::vector<SweptContact> first_contacts;  // those of the start, once the end is solved for
  std::vector<SweptImpulse> first_impulses;
  std::vector<Meeting> meetings;
  std::vector<RecalledContact> recalled;
  std::vector<int> entry_of_contact;  // in the list of those that are recalled, before it is sorted
  std::vector<double> work_of_start;  // J, of each of those
  std::vector<Vec3>
      end_velocities;  // m/s, per contact: of the sides before the impulses of the end
  std::vector<Vec3> given_at_start;  // N s, per contact of the end: of the same features
  ReturnedEnergyMemory returned_energy;
  ImpactPath impact_path;
  std::vector<ImpactPoint> impact_points;
  std::vector<FrictionSlip> friction_slips;
  std::vector<double> lost_energy;      // World's, before the step
  std::vector<double> work_of_islands;  // J, of the impulses of the start and of the end
  std::vector<int> members;             // bodies of an island, or of other groups
  std::vector<MetFreely> met_freely;
  std::vector<Partner> partners;        // of each body
  std::vector<std::uint8_t> is_pushed;  // of each body: 1 if anything has, in this step
  std::vector<SweptImpulse> of_impact;  // that is solved for
  NearGroups near_groups;
  CarriedBoxes carried_boxes;
  FallAsleep fall_asleep;
  std::vector<BodyPair> paired;               // bodies with candidates
  std::vector<std::uint8_t> is_borne;         // per box, at the start
  std::vector<BodyRest> rest;                 // as the step found it
  std::vector<OnGround> on_ground;            // per soft body
  std::vector<std::uint8_t> is_in_candidate;  // per node of the bodies
  std::vector<SunkVertex> sunk;
  VertexArray before_ground;  // of a soft body that meets nothing else
  double work = 0.0;          // J, of all contacts of the last step
  double driven_work = 0.0;   // J, of the bodies that are moved
};

/// Appends the contacts that pressed, for those who ask the stepper.
void list_pressing(const SweptMemory& memory, std::vector<Contact>& contacts);

/// Finds the contacts of one step of a world: fills the memory's contacts and impulses.
class SweptSearch {
 public:
  /// Refers to all of them. `start`: what the step starts from.
  SweptSearch(const World& world, const MotionStart& start, SweptMemory& memory)
      : world_(world), start_(start), m_(memory), bodies_(memory.bodies) {}

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
  /// what stands still or is moved, directly or through other boxes.
  void find_borne_boxes();
  /// The bodies now end elsewhere: what may meet, if that is too far from what was searched for.
  void follow_ends();
  /// The contacts that the free motion would use up.
  void start();
  /// m, that near boxes, or a box and the ground, lack at most of the distance that shifts keep.
  double greatest_missing_of_boxes() const;
  /// Fills the memory's contacts with those that keep boxes from being shifted into each other or
  /// into the ground: where there is no more than this `room` (m) between them.
  void find_contacts_of_boxes(double room);
  /// Adds to these what keeps boxes from being shifted, by `reach` (m) at most, into soft bodies.
  void find_contacts_beside_boxes(double reach);
  /// Adds to the contacts what bodies would pass through on their ways as they came out. Whether
  /// there is any.
  bool find_collisions();
  /// Of these what must not be; boxes may lie in each other for a while.
  const std::optional<BodyPair>& blocked() const { return blocked_; }

  /// Where the features of a candidate are nearest at the end, if they are in contact then or
  /// `acted` on each other at the start. None if another pair stands for it, or if nothing says
  /// where they would part.
  std::optional<SweptContact> place_at_end(const SweptCandidate& candidate, bool acted);
  /// Of two boxes, or of one and the ground: where the features are nearest at the end, if they
  /// are not in contact but so little further apart that they are hit together with others.
  std::optional<SweptContact> place_beside_hit(const SweptCandidate& candidate);
  SweptImpulse impulse(const SweptContact& contact, double friction);

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

  ContactMaterial material(const SweptContact& contact) const;
  /// Boxes, and boxes and the ground: what rests on each other stays there.
  bool is_rigid(const SweptContact& contact) const;
  /// Whether one of its sides is moved as its keys say.
  bool is_driven(const SweptContact& contact) const;
  /// m, up to which features of two bodies are in contact.
  double near_distance(int first, int second) const;

 private:
  double distance_wanted(int first, int second) const;
  const ContactMaterial& material(int body) const;
  bool is_driven(const SurfacePoint& side) const;
  void find_approach(SweptContact& contact, const Vec3& kicked) const;
  std::pair<SurfacePoint, SurfacePoint> where_impulses_act(const SweptContact& contact) const;
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
  OrientedBox start_box(int body) const;
  OrientedBox end_box(int body) const;
  bool turn_into_each_other(SweptCandidate& first_point);
  SweptContact place_before_end(const SweptCandidate& candidate, const Vec3& normal,
                                const BoxContactPoint& point) const;
  double greatest_relative_way(int first, int second) const;
  void offer_near_features(const BodyPair& bodies);
  void offer(const BodyPair& bodies, const NearFeatures& features);
  /// Gives the contacts that there are to the candidates of another search.
  void recall_contacts();
  void list_recalled();
  void put_back_missing();
  SweptCandidate missing_candidate(const RecalledContact& recalled) const;
  Vec3 normal_of(const SweptCandidate& candidate, const ClosestPoints& closest,
                 Moment moment) const;
  SweptContact place(const SweptCandidate& candidate, const ClosestPoints& closest,
                     Moment moment) const;
  SweptContact place_along_line(const SweptCandidate& candidate, double fraction);
  SweptContact place_at(const SweptCandidate& candidate, double fraction) const;
  std::optional<SweptContact> place_at_end(const SweptCandidate& candidate, bool acted,
                                           double reach);
  SweptContact move_to_end(const SweptCandidate& candidate) const;
  SweptContact place_on_ground(const SweptCandidate& candidate, Moment moment) const;
  bool stands(const SweptCandidate& candidate, const ClosestPoints& closest, Moment moment) const;
  bool find_collisions_of_pair(std::span<SweptCandidate> candidates);
  bool meets(SweptCandidate& candidate);
  void hold_where_they_meet();
  bool sinks_in(SweptCandidate& candidate);
  bool goes_into_ground(SweptCandidate& candidate);
  bool add_if_it_meets(SweptCandidate& candidate);
  void add(SweptCandidate& candidate, SweptContact contact);
  /// Whether an impulse moves a side of it: pinned vertices do not.
  bool is_moved(const SweptContact& contact);

  const World& world_;
  const MotionStart& start_;
  SweptMemory& m_;
  SweptBodies& bodies_;
  std::optional<BodyPair> blocked_;
  bool has_started_ = false;           // the contacts of the start are found
  bool are_beside_obstacles_ = false;  // any candidates
  std::size_t next_earlier_ = 0;       // of the candidates of the search before
  std::size_t next_near_ = 0;          // of the near triangles
};

}  // namespace pneuma::sim

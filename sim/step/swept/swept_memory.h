// The memory of a step with swept contacts. Private to sim/step.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "sim/base/disjoint_sets.h"
#include "sim/response/carried_boxes.h"
#include "sim/response/fall_asleep.h"
#include "sim/step/swept/swept_solver.h"
#include "sim/swept/impact_path.h"

namespace pneuma::sim {

/// What a step or a part of it began with, that has failed and is to be halved.
struct SweptStart {
  MotionStart motion;
  std::vector<WarmStartImpulse> warm_start_impulses;
  std::vector<FeatureImpulse> feature_impulses;
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

/// A point in which boxes that met nothing else have met within the step (impacts/free_impacts.h).
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
  int others = 0;  // of those with what it does not rest on
  std::size_t first_contact = 0, first_of_others = 0;
  int body = swept_ground;   // of the last of the others
  bool is_only_one = false;  // of all of these, and not near yet
  bool is_hit = false;       // in one of them it may be, and bounce
  double restitution = 1.0;  // the least of those in which it may be hit
};

/// What is static or moved beside a side of a box, or beyond a row of free boxes there.
struct WallBeside {
  double distance = std::numeric_limits<double>::infinity();  // m, the least, of all gaps
  double middle = 0.0;  // m, of all gaps, where the middles of their faces are
  double near = std::numeric_limits<double>::infinity();  // m, the least up to which is contact
  int gaps = 1;
  double mass = 0.0;        // kg, of the boxes of the row
  int body = swept_ground;  // the nearest
};
/// Along each axis of the box, that on its negative side first.
struct WallsBeside {
  std::array<std::pair<WallBeside, WallBeside>, 3> along;
};
/// A side of a free box.
struct BoxSide {
  int box = 0;
  int axis = 0;
  bool is_positive = false;
};
/// Two free boxes side by side: on each, the side where the other is.
struct BoxesInRow {
  BoxSide first, second;
  double distance = 0.0;  // m
  double middle = 0.0;    // m, where the middles of their faces are
  double near = 0.0;      // m, up to which they are in contact
};

/// What a box touches: nothing, only what stands still, or others.
enum class TouchedByBox : std::uint8_t { nothing, still, others };

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

  /// `impulse` is one of `impulses`.
  std::size_t contact_of(const SweptImpulse* impulse) const {
    return static_cast<std::size_t>(impulse - impulses.data());
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
  std::vector<Partner> partners;         // of each body
  std::vector<std::uint8_t> is_pushed;   // of each body: 1 if anything has, in this step
  std::vector<std::uint8_t> is_stopped;  // of each island of the end: a box on something soft was
  std::vector<SweptImpulse> of_impact;   // that is solved for
  NearGroups near_groups;
  CarriedBoxes carried_boxes;
  FallAsleep fall_asleep;
  std::vector<BodyPair> paired;               // bodies with candidates
  std::vector<BodyPair> without_room;         // between which shifts found none
  std::vector<std::uint8_t> between_walls;    // of each box: a bit for each of its axes
  std::vector<std::uint8_t> squeezed;         // likewise, of those along which there is no room
  std::vector<std::uint8_t> held;             // and the walls nearly move as one
  std::vector<BodyPair> without_hold;         // walls that drive what they squeeze into others
  std::vector<WallsBeside> walls_beside;      // of each box
  std::vector<BoxesInRow> rows;               // of boxes that may be between walls
  std::vector<std::uint8_t> is_borne;         // per box, at the start
  std::vector<TouchedByBox> touched_by_box;   // per box, at the start
  std::vector<double> first_meeting;          // per box, fraction of the step: with what is still
  std::vector<BodyRest> rest;                 // as the step found it
  std::vector<OnGround> on_ground;            // per soft body
  std::vector<std::uint8_t> is_in_candidate;  // per node of the bodies
  std::vector<SunkVertex> sunk;
  VertexArray before_ground;  // of a soft body that meets nothing else
  bool measures_work = false;
  double work = 0.0;         // J, of all contacts of the last step
  double driven_work = 0.0;  // J, of the bodies that are moved
};

}  // namespace pneuma::sim

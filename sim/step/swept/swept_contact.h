// Swept contacts, and what may become one. Private to sim/step.
#pragma once

#include <tuple>

#include "sim/collision/sweep_and_prune.h"
#include "sim/step/swept/swept_bodies.h"
#include "sim/swept/feature_ways.h"

namespace pneuma::sim {

/// A contact of the step, between two features or a vertex and the ground.
struct SweptContact {
  SurfacePoint first;
  SurfacePoint second;
  Vec3 normal = Vec3::Zero();   // unit, from second to first
  double distance = 0.0;        // m
  double wanted = 0.0;          // m, the distance that the bodies keep
  bool is_near = false;         // at this distance, give or take half of it
  double approach = 0.0;        // m/s, at which the sides meet
  double drift = 0.0;           // m/s, of the motion beyond the mean of the velocities at both ends
  double restitution = 0.0;     // of what bounces at the end of the step
  double parting = 0.0;         // m/s, at which the sides part at the end of the step, at least
  bool returns_energy = false;  // what parts bounces, or gets back what it lost without a touch
  bool stops = false;           // at the end: a box has hit what stands still, and does not bounce
  bool is_of_near_boxes = false;
  double gap_rate = 0.0;    // m/s, at which walls that grip open it: their share of each gap
  bool is_gripped = false;  // of boxes that walls squeeze which nearly move as one
  bool is_missed = false;   // a box turned into the ground, or away: to be aimed at once more
  bool is_new = false;  // at the end of the step: of features that no impulse of its start acted on
  bool has_met = false;   // within the step, of boxes that meet nothing else (impacts/)
  bool is_floor = false;  // of such a box, which slides on it: its end bears all of the weight
  int previous = -1;      // the contact that the same features made before this one
};

inline BodyPair pair_of(const SweptContact& contact) {
  return {contact.first.body, contact.second.body};
}

/// Whether it bounces at the end of the step.
inline bool is_hit(const SweptContact& contact) {
  return contact.returns_energy && contact.is_near;
}
/// Whether it is an impact, which may bounce.
inline bool is_impact(const SweptContact& contact) { return is_hit(contact) || contact.stops; }

/// Features of two bodies, or of one and the ground, that may meet in the step; or a point of the
/// contact of two boxes that are near each other when it starts, and may overlap.
struct SweptCandidate {
  BodyPair bodies;
  NearFeatures features{};        // of near boxes: the number of the point, twice
  ClosestPoints start{};          // where they are nearest then; not of the ground
  int contact = -1;               // the last contact of the start that this has made, if any
  bool is_of_near_boxes = false;  // then the start's distance is < 0 where they overlap
  Vec3 normal = Vec3::Zero();     // of near boxes: unit, from the second to the first
};

/// Candidates and contacts are in this order of their bodies, the ground last.
inline std::tuple<bool, int, int> in_order(int first, int second) {
  return {second == swept_ground, first, second};
}

/// Impulses on boxes act at one common point, so that no couple is left.
inline void meet_halfway(SurfacePoint& first, SurfacePoint& second) {
  first.point = second.point = 0.5 * (first.point + second.point);
}

}  // namespace pneuma::sim

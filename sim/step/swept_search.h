// The contacts of a step in which nothing passes through anything: found among all features whose
// ways come near each other. Private to sim/step.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "sim/step/swept_bodies.h"

namespace pneuma::sim {

/// A contact of the step, between two features or a vertex and the ground.
struct SweptContact {
  SurfacePoint first;
  SurfacePoint second;
  Vec3 normal = Vec3::Zero();  // unit, from second to first
  double distance = 0.0;       // m
  double wanted = 0.0;         // m, the distance that the bodies keep
  bool is_near = false;        // at this distance, give or take half of it
  double approach = 0.0;       // m/s, at which the sides meet
};

/// Where a contact of two features is in a list.
class SweptIndex {
 public:
  void clear() { entries_.clear(); }
  /// False if it is there already.
  bool insert(const SweptContact& contact, int number);
  /// The number of the contact of the same features, or -1.
  int find(const SweptContact& contact) const;

 private:
  using Key = std::array<int, 6>;
  static Key key(const SweptContact& contact);

  std::vector<std::pair<Key, int>> entries_;  // in ascending order
};

/// Before a step or a part of it: what is taken back if it fails.
struct SweptStart {
  std::vector<SoftState> soft;
  std::vector<RigidStart> rigid;
  std::vector<WarmStartImpulse> warm_start_impulses;
};

/// How often a step may be halved: to a 256th.
inline constexpr int max_halvings = 8;

struct SweptMemory {
  explicit SweptMemory(const World& world) : bodies(world), starts(max_halvings + 1) {}

  SweptBodies bodies;
  std::vector<SweptStart> starts;  // by how often the step has been halved
  std::vector<BodyPair> near_bodies;
  /// Features of two bodies, or of one and the ground, that may meet.
  struct Candidate {
    BodyPair bodies;
    NearFeatures features;
  };
  std::vector<Candidate> candidates;
  std::vector<NearFeatures> found;  // of two bodies
  std::vector<SweptContact> contacts;
  std::vector<SweptImpulse> impulses;        // of the contacts, one each
  SweptIndex index;                          // of the contacts at the start
  std::vector<SweptContact> first_contacts;  // those of the start, once the end is solved for
  std::vector<SweptImpulse> first_impulses;
  double work = 0.0;  // J, by all impulses of the last step
};

/// Finds the contacts of one step of a world: fills the memory's contacts and impulses.
class SweptSearch {
 public:
  /// Refers to all of them. `start`: what the step starts from.
  SweptSearch(const World& world, const MotionStart& start, SweptMemory& memory)
      : world_(world), start_(start), m_(memory), bodies_(memory.bodies) {}

  /// The contacts that the free motion would use up.
  void start();
  /// Of the motion as it came out.
  void find_candidates();
  /// Adds what was found on the way to the contacts. Whether anything is in the way of the step.
  bool find_collisions();
  /// What was in the way last.
  const BodyPair& blocked() const { return blocked_; }

  /// Where the features of a candidate are nearest. None if another pair stands for it, or if
  /// nothing says where they would part.
  std::optional<SweptContact> place(const SweptMemory::Candidate& candidate, Moment moment) const;
  SweptImpulse impulse(const SweptContact& contact, double friction);

  /// Of the first side against the second, m.
  Vec3 displacement(const SweptContact& contact) const;
  /// m/s.
  Vec3 start_velocity(const SweptContact& contact) const;
  Vec3 end_velocity(const SweptContact& contact) const;

  ContactMaterial material(const SweptContact& contact) const;
  /// Boxes, and boxes and the ground: what rests on each other stays there.
  bool is_rigid(const SweptContact& contact) const;
  /// Indices into World::rigid, -1 for the ground.
  std::pair<int, int> boxes(const SweptContact& contact) const;

 private:
  double distance_wanted(int first, int second) const;
  double slack(int first, int second) const;
  const ContactMaterial& material(int body) const;
  double speed_of_meeting(const SweptContact& contact, double moved) const;
  void find_near_ground();
  SweptContact place_on_ground(int body, const Feature& vertex, Moment moment) const;
  bool goes_into_ground(const SweptMemory::Candidate& candidate);
  bool add(SweptContact contact, double moved);
  bool add_if_it_meets(const SweptContact& contact);

  const World& world_;
  const MotionStart& start_;
  SweptMemory& m_;
  SweptBodies& bodies_;
  BodyPair blocked_;
};

}  // namespace pneuma::sim

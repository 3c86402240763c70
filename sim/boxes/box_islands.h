// Boxes that in a step only boxes, the ground and what is moved can touch: they are moved in
// substeps, island by island, and not by swept contacts. For sim/step alone.
//
// An island is boxes that come near each other. What a soft body comes near, what is fast for its
// size, bounces well, lies deep in another or has another's mass many times belongs to swept
// contacts, and its island with it; so do towers, which their Newton's method holds.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/collision/contact.h"
#include "sim/collision/sweep_and_prune.h"
#include "sim/step/swept_bodies.h"

namespace pneuma::sim {

class BoxIslandMover;

/// What moved islands leave for others to know.
struct BoxIslandsMoved {
  std::vector<BodyPair> near_pairs;        // of bodies that do or might touch
  std::vector<Contact> contacts;           // that press
  std::vector<WarmStartImpulse> impulses;  // for the next step
  double work = 0.0;                       // J, of contacts, beside the free motion
  double driven_work = 0.0;                // J, by what is driven

  void clear();
};

class BoxIslands {
 public:
  explicit BoxIslands(const World& world);
  BoxIslands(BoxIslands&&) noexcept;
  ~BoxIslands();

  /// A new step: no box is known to belong to swept contacts.
  void begin_step();
  /// For the rest of the step the body's island does.
  void exclude(int body) { is_excluded_[at(body)] = 1; }

  /// After the free motion from `start`, moves the boxes that it is for in place of that, and tells
  /// `bodies` which these are.
  void move(World& world, const MotionStart& start, SweptBodies& bodies);

  /// Bodies that something may touch that is awake: if there are any, the step is to be done with
  /// them awake, and nothing was moved.
  const std::vector<int>& touched_asleep() const { return touched_asleep_; }
  const BoxIslandsMoved& moved() const;

 private:
  /// Of an island.
  struct Traits {
    double lightest = 0.0, heaviest = 0.0;  // kg
    double thinnest = 0.0;                  // m
    double longest_way = 0.0;               // m in the step, of any point
    double restitution = 0.0;
    double lowest = 0.0, highest = 0.0;  // m against gravity, of centres
    int members = 0;
    bool is_swept = false;
    bool touches = false;  // anything
  };

  void find_ways(const World& world, const MotionStart& start, SweptBodies& bodies);
  void find_way(const World& world, const MotionStart& start, const SweptBodies& bodies, int body);
  void wake_by(const World& world, const SweptBodies& bodies, int body, int sleeping);
  void find_islands(const World& world);
  void find_traits(const World& world, const SweptBodies& bodies);
  void include(Traits& traits, const World& world, const SweptBodies& bodies, int body) const;
  static bool is_for_substeps(const Traits& traits);
  void list_islands(const World& world, const SweptBodies& bodies);
  int root(int body);

  std::vector<std::uint8_t> is_excluded_;   // per body
  std::vector<std::uint8_t> is_on_ground_;  // per body: near it
  std::vector<Bounds> ways_;                // per body, with what contacts may add to them
  std::vector<double> way_lengths_;         // m, per body: of any point of a box
  std::vector<BoundingSphere> spheres_;     // about the ways
  SweepAndPrune sweep_and_prune_;
  std::vector<BodyPair> pairs_;  // of ways that overlap
  std::vector<int> touched_asleep_;
  std::vector<int> parents_;                    // per body
  std::vector<Traits> traits_;                  // per body; of roots
  std::vector<int> member_begin_, pair_begin_;  // per body, of roots
  std::vector<int> filled_;
  std::vector<int> members_;            // by their roots
  std::vector<BodyPair> island_pairs_;  // likewise, each once; -1: the ground
  std::unique_ptr<BoxIslandMover> mover_;
};

}  // namespace pneuma::sim

// Moves an island of boxes through a step in substeps. For sim/step alone.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/boxes/box_islands.h"
#include "sim/boxes/substep_solver.h"

namespace pneuma::sim {

/// An island as it is found.
struct BoxIsland {
  std::span<const int> members;     // bodies
  std::span<const BodyPair> pairs;  // that may touch: of members, with what is driven, sleeps, or
                                    // the ground (-1) as second
  double longest_way = 0.0;         // m, of a point in the free motion
  double thinnest = 0.0;            // m
};

class BoxIslandMover {
 public:
  explicit BoxIslandMover(const World& world);

  /// Before the islands of a step.
  void begin(const World& world);
  /// From `start`; the world is at the end of its free motion. False, and nothing is done, if boxes
  /// lie too deep in each other.
  bool move(World& world, const MotionStart& start, const SweptBodies& bodies,
            const BoxIsland& island);
  const BoxIslandsMoved& moved() const { return moved_; }

 private:
  /// Of a step. Contacts are found once a part.
  struct Division {
    int parts = 1;
    int substeps = 1;  // of each part
    double fineness = 1.0;
    double may_sink = 0.0;  // of the shortest side, in the step; 0: nobody looks
  };
  struct PairOfNumbers {
    BodyPair bodies;
    int first = 0;  // in the solver
    int second = 0;
  };

  void list_impulses(const World& world);
  /// m, that bodies keep.
  static double gap(const SweptBodies& bodies, const BodyPair& pair);
  static std::array<Division, 2> divisions_of(const BoxIsland& island);
  bool try_to_move(World& world, const MotionStart& start, const SweptBodies& bodies,
                   const BoxIsland& island, const Division& division);
  bool have_sunk(double allowed);
  void add_boxes(World& world, const MotionStart& start, const BoxIsland& island, double fineness);
  int number_of(const World& world, const MotionStart& start, int body);
  void forget_numbers(const BoxIsland& island);
  bool find_contacts(const World& world, const SweptBodies& bodies, double seconds);
  double reach(const PairOfNumbers& pair, double seconds, const Vec3& gravity) const;
  void add_contact(const World& world, const SweptBodies& bodies, std::size_t pair,
                   const BoxContact& found);
  void start_from_last_step(const World& world, const SweptBodies& bodies, const BodyPair& pair,
                            SubstepContact& contact);
  void start_from_last_part(std::size_t pair, SubstepContact& contact);
  void take_back(World& world, const MotionStart& start, const SweptBodies& bodies,
                 const BoxIsland& island);
  double energy(const World& world) const;
  void report(const SweptBodies& bodies);

  std::vector<int> impulse_begin_, ordered_impulses_, filled_;  // of the last step, by first box
  BoxIslandsMoved moved_;

  SubstepSolver solver_;
  std::vector<RigidBox*> boxes_;
  std::vector<PairOfNumbers> pairs_;
  std::vector<int> numbers_;  // per body and the ground; -1: none
  std::vector<int> others_;   // bodies with numbers that are no members
  std::vector<std::size_t> pair_of_contact_, pair_of_last_contact_;
  std::vector<SubstepContact> last_contacts_;  // of the part before
  std::size_t next_last_contact_ = 0;
  double thinnest_ = 0.0;
  int substeps_per_step_ = 1;
  bool rests_ = false;  // and has few members
  bool is_first_part_ = true;
  bool is_held_ = false;    // by the ground, or by what is driven
  bool is_driven_ = false;  // by what moves
};

}  // namespace pneuma::sim

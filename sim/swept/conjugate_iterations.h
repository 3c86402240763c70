// Gauss-Seidel iterations that go on in the directions in which they went: the nonsmooth nonlinear
// conjugate gradients of Silcowitz-Hansen, Niebe and Erleben (2010, "A nonsmooth nonlinear
// conjugate gradient method for interactive contact force problems"). In heaps of boxes a fifth of
// the iterations come as far.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <tuple>
#include <vector>

#include "sim/swept/four_box_impulses.h"
#include "sim/swept/swept_impulse.h"

namespace pneuma::sim {

class ConjugateIterations {
 public:
  /// Of these impulses are the next corrections. Allocates nothing once their number has peaked.
  void begin(std::span<SweptImpulse* const> impulses);
  /// Corrects all impulses in turn until no correction changes a velocity by more than `tolerance`,
  /// in the unit of what they aim at, in at most `max_iterations`. Those between boxes come first,
  /// pair by pair, and four pairs at once that have no box in common. After each but the last goes
  /// on by the conjugate direction: the limits of impulses hold again after the next. Returns the
  /// greatest change of the last.
  double correct(double tolerance, int max_iterations);

 private:
  /// Of an impulse on a soft body, N s.
  struct Way {
    Vec4d correction{};  // of the last iteration: the gradient with its sign turned
    Vec4d direction{};   // in which it goes on
  };
  /// Impulses between the same boxes, or between a box and what nothing moves.
  struct Pair {
    std::size_t colour = 0;
    std::size_t begin = 0, count = 0;  // of its impulses

    /// In the order in which they are put together: what has as many impulses side by side.
    auto order() const { return std::tuple(colour, -static_cast<std::ptrdiff_t>(count), begin); }
  };
  /// Pairs without a common box, one in each lane.
  struct FourPairs {
    std::array<BoxChange*, 4> first{}, second{};
    std::size_t begin = 0, end = 0;  // of their impulses, in which each has one more
  };
  /// Of a box that the impulses act on.
  struct Moved {
    BoxChange* box = nullptr;
    Vec4d velocity{}, angular_velocity{};  // before the last iteration
    Vec4d direction{}, turn{};             // in which it goes on, m/s and rad/s
  };

  void find_pairs(std::span<SweptImpulse* const> impulses);
  void put_together();
  void put_together(std::span<const Pair> pairs);
  void find_moved_boxes(std::span<SweptImpulse* const> impulses);
  double iterate();
  void correct_boxes(FourBoxImpulses::Change& change);
  void note_velocities();
  void go_on();

  std::vector<SweptImpulse*> between_boxes_, others_;
  std::vector<Pair> pairs_;
  std::vector<FourPairs> fours_;
  std::vector<FourBoxImpulses> of_boxes_;
  BoxChange nothing_;  // in place of a box, where there is none: no impulse changes it
  std::vector<Moved> moved_;
  std::vector<Way> ways_;        // of the others
  double squared_ = 0.0;         // J, of the corrections, each by its mobility
  double squared_before_ = 0.0;  // of the iteration before; 0: there is none
  double ratio_ = 0.0;           // by which the next iteration goes on
};

}  // namespace pneuma::sim

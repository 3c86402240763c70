// Gauss-Seidel iterations that go on in the directions in which they went: the nonsmooth nonlinear
// conjugate gradients of Silcowitz-Hansen, Niebe and Erleben (2010, "A nonsmooth nonlinear
// conjugate gradient method for interactive contact force problems"). In heaps of boxes a fifth of
// the iterations come as far.
#pragma once

#include <span>
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
  /// as many at once as have no box in common. After each but the last goes on by the conjugate
  /// direction: the limits of impulses hold again after the next. Returns the greatest change of
  /// the last.
  double correct(double tolerance, int max_iterations);

 private:
  /// Of an impulse on a soft body, N s.
  struct Way {
    Vec4d correction{};  // of the last iteration: the gradient with its sign turned
    Vec4d direction{};   // in which it goes on
  };
  struct Coloured {
    std::size_t colour = 0;
    SweptImpulse* impulse = nullptr;
  };

  void sort_by_colour(std::span<SweptImpulse* const> impulses);
  void put_together();
  double iterate();
  void go_on();

  std::vector<Coloured> coloured_, sorted_;  // those between boxes
  std::vector<FourBoxImpulses> of_boxes_;
  std::vector<SweptImpulse*> others_;
  std::vector<Way> ways_;        // of the others
  double squared_ = 0.0;         // J, of the corrections, each by its mobility
  double squared_before_ = 0.0;  // of the iteration before; 0: there is none
};

}  // namespace pneuma::sim

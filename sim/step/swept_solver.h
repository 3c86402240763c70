// The impulses of a step with swept contacts, solved for island by island. Private to sim/step.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/base/disjoint_sets.h"
#include "sim/step/swept_contact.h"
#include "sim/swept/conjugate_iterations.h"
#include "sim/swept/newton_solver.h"

namespace pneuma::sim {

class SweptSolver {
 public:
  /// `bodies`: how many there are, of which the first are soft.
  SweptSolver(int bodies, int soft_bodies) : soft_bodies_(soft_bodies), sets_(at(bodies)) {}

  /// Corrects the impulses of the contacts until none changes a velocity by more than `tolerance`,
  /// in the unit of what they aim at, or 50 times, by Gauss-Seidel iterations. Where a box is on a
  /// box or on the ground until none does by more than a hundredth of it, by Newton's method too,
  /// if that can help. Islands without a contact from `first_new` on stay as they are: what happens
  /// elsewhere does not reach them.
  void solve(std::span<const SweptContact> contacts, std::span<SweptImpulse> impulses,
             double tolerance, std::size_t first_new = 0);
  /// The same for one of the islands that the last call has found.
  void solve_island(int island, double tolerance);
  int island_count() const { return static_cast<int>(begin_.size()) - 1; }
  /// Those of an island that the last call has found.
  std::span<SweptImpulse* const> impulses_of(int island) const {
    const std::size_t begin = begin_[at(island)];
    return std::span(ordered_).subspan(begin, begin_[at(island) + 1] - begin);
  }
  /// -1: in none. `body` has been in a contact of the last call, or in none at all. What nothing
  /// moves is in none.
  int island_of(int body) { return islands_[at(sets_.find(body))]; }
  /// Of the body or bodies that the contact's impulse moves.
  int island_of(const SweptContact& contact, const SweptImpulse& impulse);

 private:
  /// Contacts that share a body that they move, and those that share one with these, are an island:
  /// nothing travels through boxes that stand still or keep their velocity.
  void divide(std::span<const SweptContact> contacts, std::span<SweptImpulse> impulses);
  void solve_with_boxes(std::span<SweptImpulse* const> impulses, double tolerance);

  bool is_box(int body) const { return body >= soft_bodies_; }

  int soft_bodies_ = 0;
  base::DisjointSets sets_;              // of bodies
  std::vector<int> islands_;             // of the first body of each set, or -1
  std::vector<std::uint8_t> is_new_;     // per island
  std::vector<std::uint8_t> has_boxes_;  // per island: one on another, or on the ground
  std::vector<std::size_t> begin_;
  std::vector<std::size_t> filled_;
  std::vector<SweptImpulse*> ordered_;  // by island
  ConjugateIterations iterations_;
  NewtonSolver newton_;
};

}  // namespace pneuma::sim

// The impulses of a step with swept contacts, solved for patch by patch. Private to sim/step.
//
// Contacts that move a common body, and those that move one with these, are an island: within a
// step nothing reaches others, and nothing travels through boxes that stand still or keep their
// velocity. An impulse on a soft body moves only the vertices of a feature, until the body's
// springs act. So an island falls into patches, whose contacts move common vertices or boxes, and
// each patch is solved for by itself.
#pragma once

#include <compare>
#include <span>
#include <vector>

#include "sim/base/disjoint_sets.h"
#include "sim/step/swept/swept_bodies.h"
#include "sim/step/swept/swept_contact.h"
#include "sim/swept/conjugate_iterations.h"
#include "sim/swept/gauss_seidel.h"
#include "sim/swept/newton_solver.h"

namespace pneuma::sim {

/// Of the tolerance that is asked for, where boxes are on boxes or the ground: what is left makes a
/// stack tremble, and a heap creep.
inline constexpr double tolerance_of_boxes = 0.01;

class SweptSolver {
 public:
  /// Refers to the bodies.
  explicit SweptSolver(const SweptBodies& bodies)
      : bodies_(bodies),
        linked_bodies_(at(bodies.count())),
        linked_nodes_(at(bodies.node_count())),
        gauss_seidel_(at(bodies.node_count())) {}

  /// Corrects the impulses of the contacts until none changes a velocity by more than `tolerance`,
  /// in the unit of what they aim at, or 50 times, by Gauss-Seidel iterations. Where a box is on a
  /// box or on the ground until none does by more than a hundredth of it, by Newton's method too,
  /// if that can help; beside soft bodies 20 times at most once `tolerance` is met. Patches without
  /// a contact from `first_new` on stay: what springs bring from others in a step done again is
  /// left. What is moved is let go where boxes are pressed against it without room.
  void solve(std::span<const SweptContact> contacts, std::span<SweptImpulse> impulses,
             double tolerance, std::size_t first_new = 0);
  /// The same for impulses that shift boxes. Returns false if there was no room: then what does not
  /// give way to them was let go.
  bool solve_shifts(std::span<const SweptContact> contacts, std::span<SweptImpulse> impulses,
                    double tolerance);
  /// The same for one of the islands that the last call has found.
  void solve_island(int island, double tolerance);
  int island_count() const { return static_cast<int>(island_begin_.size()) - 1; }
  /// Those of an island that the last call has found.
  std::span<SweptImpulse* const> impulses_of(int island) const {
    const std::size_t begin = island_begin_[at(island)], end = island_begin_[at(island) + 1];
    const std::size_t first = patches_[begin].begin;
    return std::span(ordered_).subspan(first, patches_[end].begin - first);
  }
  /// -1: in none. `body` has been in a contact of the last call, or in none at all. What nothing
  /// moves is in none.
  int island_of(int body) { return islands_[at(linked_bodies_.find(body))]; }
  /// Of the body or bodies that the contact's impulse moves.
  int island_of(const SweptContact& contact, const SweptImpulse& impulse);

 private:
  /// A contact by what it belongs to: the first body of its island, the first node of its patch.
  struct Place {
    int body = 0;
    int node = 0;
    int contact = 0;

    auto operator<=>(const Place&) const = default;
  };
  struct Patch {
    std::size_t begin = 0;   // of its impulses
    bool is_new = false;     // it has a contact that was not yet solved for
    bool has_boxes = false;  // one on another, or on the ground; or it is of shifts
    bool is_pushed = false;  // it has a contact with what does not give way, but is no ground
  };

  void solve_patches(std::span<const SweptContact> contacts, std::span<SweptImpulse> impulses,
                     double tolerance, std::size_t first_new, bool are_shifts);
  void divide(std::span<const SweptContact> contacts, std::span<SweptImpulse> impulses,
              std::size_t first_new, bool are_shifts);
  void link(std::span<const SweptContact> contacts, std::span<const SweptImpulse> impulses);
  void sort_by_place(std::span<const SweptContact> contacts,
                     std::span<const SweptImpulse> impulses);
  bool is_of_boxes(const SweptContact& contact) const;
  int pusher(const SweptContact& contact, const SweptImpulse& impulse, bool are_shifts) const;
  ImpulseNodes nodes_of(const SweptContact& contact, const SweptImpulse& impulse) const;
  void solve_patch(std::size_t patch, double tolerance);
  void solve_pushed(std::span<SweptImpulse* const> impulses, std::span<const int> pushers,
                    double tolerance);
  double enough_for_all(std::span<SweptImpulse* const> impulses);
  static double push(std::span<SweptImpulse* const> impulses, std::span<const int> pushers,
                     std::size_t one);
  static bool any_pushes(std::span<SweptImpulse* const> impulses, std::span<const int> pushers,
                         double most);
  void let_go(std::span<SweptImpulse* const> impulses, std::span<const int> pushers, double most);
  double solve_with_boxes(std::span<SweptImpulse* const> impulses, double tolerance);
  bool improve(double penalty, double growth, double tolerance, double& left);

  const SweptBodies& bodies_;
  base::DisjointSets linked_bodies_;
  base::DisjointSets linked_nodes_;
  std::vector<int> islands_;               // of the first body of each set, or -1
  std::vector<std::size_t> island_begin_;  // its first patch, and the end
  std::vector<Patch> patches_;             // island by island, and the end
  std::vector<ImpulseNodes> nodes_of_contacts_;
  std::vector<Place> places_;
  std::vector<SweptImpulse*> ordered_;  // patch by patch
  std::vector<int> pushers_;            // of each of these
  std::vector<ImpulseNodes> nodes_;
  std::vector<const BoxChange*> boxes_;  // of a patch
  bool has_let_go_ = false;
  GaussSeidel gauss_seidel_;
  ConjugateIterations iterations_;
  NewtonSolver newton_;
};

}  // namespace pneuma::sim

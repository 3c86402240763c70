#include "sim/step/swept_solver.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace pneuma::sim {
namespace {

/// Before Newton's method is tried, and where it cannot help: in a heap, and among soft bodies,
/// whose loads are carried through the bodies and not from contact to contact.
constexpr int few_iterations = 20;
constexpr int many_iterations = 50;
/// What is left makes a stack tremble.
constexpr double tolerance_of_boxes = 0.01;
/// Each call to Newton's method with so many times the penalty of the one before.
constexpr double first_penalty = 1e3;
constexpr double last_penalty = 1e9;
constexpr double penalty_growth = 30.0;

int moved_body(const SweptContact& contact, const SweptImpulse& impulse) {
  return impulse.first().moves() ? contact.first.body : contact.second.body;
}

}  // namespace

int SweptSolver::island_of(const SweptContact& contact, const SweptImpulse& impulse) {
  return island_of(moved_body(contact, impulse));
}

void SweptSolver::divide(std::span<const SweptContact> contacts, std::span<SweptImpulse> impulses) {
  sets_.reset();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const SweptContact& contact = contacts[i];
    if (!impulses[i].first().moves() || !impulses[i].second().moves()) continue;
    sets_.unite(contact.first.body, contact.second.body);
  }
  islands_.assign(sets_.size(), -1);
  begin_.assign(1, 0);
  has_boxes_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const SweptContact& contact = contacts[i];
    int& island = islands_[at(sets_.find(moved_body(contact, impulses[i])))];
    if (island < 0) {
      island = static_cast<int>(begin_.size()) - 1;
      begin_.push_back(0);
      has_boxes_.push_back(0);
    }
    ++begin_[at(island) + 1];
    const int second = contact.second.body;
    if (is_box(contact.first.body) && (second == swept_ground || is_box(second))) {
      has_boxes_[at(island)] = 1;
    }
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  filled_.assign(begin_.begin(), begin_.end());
  ordered_.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const int island = island_of(contacts[i], impulses[i]);
    ordered_[filled_[at(island)]++] = &impulses[i];
  }
}

void SweptSolver::solve(std::span<const SweptContact> contacts, std::span<SweptImpulse> impulses,
                        double tolerance, std::size_t first_new) {
  divide(contacts, impulses);
  is_new_.assign(at(island_count()), 0);
  for (std::size_t i = first_new; i < contacts.size(); ++i) {
    is_new_[at(island_of(contacts[i], impulses[i]))] = 1;
  }
  for (int i = 0; i < island_count(); ++i) {
    if (is_new_[at(i)] != 0) solve_island(i, tolerance);
  }
}

void SweptSolver::solve_island(int island, double tolerance) {
  if (has_boxes_[at(island)]) {
    solve_with_boxes(impulses_of(island), tolerance);
  } else {
    correct_in_turn(impulses_of(island), tolerance, many_iterations);
  }
}

void SweptSolver::solve_with_boxes(std::span<SweptImpulse* const> impulses, double tolerance) {
  const double of_boxes = tolerance_of_boxes * tolerance;
  if (iterations_.correct(impulses, of_boxes, few_iterations) <= of_boxes) return;
  const bool is_small = newton_.begin(impulses);
  for (double penalty = first_penalty; penalty < last_penalty; penalty *= penalty_growth) {
    if (!is_small || !newton_.improve(penalty)) {
      iterations_.correct(impulses, tolerance, many_iterations - few_iterations);
      return;
    }
    if (iterations_.correct(impulses, of_boxes, few_iterations) <= of_boxes) return;
  }
}

}  // namespace pneuma::sim

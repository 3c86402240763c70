#include "sim/step/swept_solver.h"

#include <algorithm>

namespace pneuma::sim {
namespace {

/// Before Newton's method is tried, and where it cannot help: in a heap, and among soft bodies,
/// whose loads are carried through the bodies and not from contact to contact.
constexpr int few_iterations = 20;
constexpr int many_iterations = 50;
/// What is left makes a stack tremble, and a heap creep.
constexpr double tolerance_of_boxes = 0.01;
/// Each call to Newton's method with so many times the penalty of the one before.
constexpr double first_penalty = 1e3;
constexpr double last_penalty = 1e9;
constexpr double penalty_growth = 30.0;

/// In place of a node: of contacts with what sleeps, which will be woken and the step done again.
constexpr int nothing_moves = -1;

int moved_body(const SweptContact& contact, const SweptImpulse& impulse) {
  return impulse.first().moves() ? contact.first.body : contact.second.body;
}

}  // namespace

int SweptSolver::island_of(const SweptContact& contact, const SweptImpulse& impulse) {
  return island_of(moved_body(contact, impulse));
}

void SweptSolver::divide(std::span<const SweptContact> contacts, std::span<SweptImpulse> impulses,
                         std::size_t first_new) {
  link(contacts, impulses);
  sort_by_place(contacts, impulses);
  islands_.assign(linked_bodies_.size(), -1);
  island_begin_.clear();
  patches_.clear();
  ordered_.clear();
  nodes_.clear();
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const auto& [body, node, contact] = places_[i];
    const bool begins_island = i == 0 || body != places_[i - 1].body;
    if (begins_island) {
      islands_[at(body)] = static_cast<int>(island_begin_.size());
      island_begin_.push_back(patches_.size());
    }
    if (begins_island || node != places_[i - 1].node) patches_.push_back({.begin = i});
    patches_.back().is_new |= node != nothing_moves && at(contact) >= first_new;
    patches_.back().has_boxes |= is_of_boxes(contacts[at(contact)]);
    ordered_.push_back(&impulses[at(contact)]);
    nodes_.push_back(nodes_of_contacts_[at(contact)]);
  }
  island_begin_.push_back(patches_.size());
  patches_.push_back({.begin = ordered_.size()});
}

/// The bodies that each contact's impulse moves, and of these what it moves at once.
void SweptSolver::link(std::span<const SweptContact> contacts,
                       std::span<const SweptImpulse> impulses) {
  nodes_of_contacts_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    nodes_of_contacts_.push_back(nodes_of(contacts[i], impulses[i]));
    for (const int node : nodes_of_contacts_.back()) {
      if (node >= 0) linked_nodes_.reset(node);
    }
  }
  linked_bodies_.reset();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ImpulseNodes& nodes = nodes_of_contacts_[i];
    for (const int node : nodes) {
      if (node >= 0) linked_nodes_.unite(nodes.front(), node);
    }
    if (!impulses[i].first().moves() || !impulses[i].second().moves()) continue;
    linked_bodies_.unite(contacts[i].first.body, contacts[i].second.body);
  }
}

ImpulseNodes SweptSolver::nodes_of(const SweptContact& contact, const SweptImpulse& impulse) const {
  ImpulseNodes nodes{-1, -1, -1, -1, -1, -1};
  std::size_t count = 0;
  const auto add = [&](int node) { nodes[count++] = node; };
  if (impulse.first().moves()) bodies_.for_each_node(contact.first, add);
  if (impulse.second().moves()) bodies_.for_each_node(contact.second, add);
  return nodes;
}

void SweptSolver::sort_by_place(std::span<const SweptContact> contacts,
                                std::span<const SweptImpulse> impulses) {
  places_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const int node = nodes_of_contacts_[i].front();
    places_.push_back({.body = linked_bodies_.find(moved_body(contacts[i], impulses[i])),
                       .node = node < 0 ? nothing_moves : linked_nodes_.find(node),
                       .contact = static_cast<int>(i)});
  }
  std::ranges::sort(places_);
}

bool SweptSolver::is_of_boxes(const SweptContact& contact) const {
  const int second = contact.second.body;
  return bodies_.is_rigid(contact.first.body) &&
         (second == swept_ground || bodies_.is_rigid(second));
}

void SweptSolver::solve(std::span<const SweptContact> contacts, std::span<SweptImpulse> impulses,
                        double tolerance, std::size_t first_new) {
  divide(contacts, impulses, first_new);
  for (std::size_t i = 0; i + 1 < patches_.size(); ++i) {
    if (patches_[i].is_new) solve_patch(i, tolerance);
  }
}

void SweptSolver::solve_island(int island, double tolerance) {
  for (std::size_t i = island_begin_[at(island)]; i < island_begin_[at(island) + 1]; ++i) {
    solve_patch(i, tolerance);
  }
}

void SweptSolver::solve_patch(std::size_t patch, double tolerance) {
  const auto& [begin, is_new, has_boxes] = patches_[patch];
  const std::size_t size = patches_[patch + 1].begin - begin;
  const std::span<SweptImpulse* const> impulses = std::span(ordered_).subspan(begin, size);
  if (has_boxes) {
    solve_with_boxes(impulses, tolerance);
  } else {
    const std::span<const ImpulseNodes> nodes = std::span(nodes_).subspan(begin, size);
    gauss_seidel_.correct(impulses, nodes, tolerance, many_iterations);
  }
}

void SweptSolver::solve_with_boxes(std::span<SweptImpulse* const> impulses, double tolerance) {
  const double of_boxes = tolerance_of_boxes * tolerance;
  iterations_.begin(impulses);
  if (iterations_.correct(of_boxes, few_iterations) <= of_boxes) return;
  const bool is_small = newton_.begin(impulses);
  for (double penalty = first_penalty; penalty < last_penalty; penalty *= penalty_growth) {
    if (!is_small || !newton_.improve(penalty)) {
      iterations_.correct(of_boxes, many_iterations - few_iterations);
      return;
    }
    if (iterations_.correct(of_boxes, few_iterations) <= of_boxes) return;
  }
}

}  // namespace pneuma::sim

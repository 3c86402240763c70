#include "sim/step/swept/swept_solver.h"

#include <algorithm>
#include <limits>

namespace pneuma::sim {
namespace {

/// Before Newton's method is tried, and where it cannot help: in a heap, and among soft bodies,
/// whose loads are carried through the bodies and not from contact to contact.
constexpr int few_iterations = 20;
constexpr int many_iterations = 50;
/// Each call to Newton's method with so many times the penalty of the one before.
constexpr double first_penalty = 1e3, penalty_growth = 30.0;
/// The same where that does not converge, masses differ by more than the ratio, and so many times
/// the tolerance is left: a third of the thinnest skin in a step.
constexpr double least_penalty = 1.0, least_growth = 10.0, mass_ratio = 10.0, unsolved = 300.0;
constexpr double last_penalty = 1e9;

/// What has no mass, and what leaves no room, is not kept apart by any impulse. An impulse may be
/// so many times what would give all that the patch moves the speed that is missing: levers and
/// wedges ask for some hundred times as much.
constexpr double most_of_enough = 1000.0;
/// Impulses of more than so many times are iterated on, so many times more, where they have not
/// been solved for: without room they grow.
constexpr double few_of_enough = 3.0, most_of_unsolved = 30.0;
constexpr int more_iterations = 500;
/// How often what pushes with more is let go.
constexpr int max_let_go = 4;

/// In place of a node: of contacts with what sleeps, which will be woken and the step done again.
constexpr int nothing_moves = -1;

/// Of two impulses with what pushes in them, or -1.
bool have_same_bodies(std::span<SweptImpulse* const> impulses, std::span<const int> pushers,
                      std::size_t one, std::size_t other) {
  const SweptImpulse &a = *impulses[one], &b = *impulses[other];
  return pushers[one] == pushers[other] && a.first().box() == b.first().box() &&
         a.second().box() == b.second().box();
}

/// Boxes do.
bool have_different_masses(std::span<SweptImpulse* const> impulses) {
  double least = std::numeric_limits<double>::infinity(), greatest = 0.0;
  for (const SweptImpulse* impulse : impulses) {
    for (const SweptSide* side : {&impulse->first(), &impulse->second()}) {
      if (!side->box()) continue;
      least = std::min(least, side->box()->inverse_mass);
      greatest = std::max(greatest, side->box()->inverse_mass);
    }
  }
  return greatest > mass_ratio * least;
}

bool any_soft(std::span<SweptImpulse* const> impulses) {
  return !std::ranges::all_of(impulses, &SweptImpulse::is_of_boxes);
}

int moved_body(const SweptContact& contact, const SweptImpulse& impulse) {
  return impulse.first().moves() ? contact.first.body : contact.second.body;
}

}  // namespace

int SweptSolver::island_of(const SweptContact& contact, const SweptImpulse& impulse) {
  return island_of(moved_body(contact, impulse));
}

void SweptSolver::divide(std::span<const SweptContact> contacts, std::span<SweptImpulse> impulses,
                         std::size_t first_new, bool are_shifts) {
  link(contacts, impulses);
  sort_by_place(contacts, impulses);
  islands_.assign(linked_bodies_.size(), -1);
  island_begin_.clear();
  patches_.clear();
  ordered_.clear();
  pushers_.clear();
  nodes_.clear();
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const auto& [body, node, contact] = places_[i];
    const bool begins_island = i == 0 || body != places_[i - 1].body;
    if (begins_island) {
      islands_[at(body)] = static_cast<int>(island_begin_.size());
      island_begin_.push_back(patches_.size());
    }
    if (begins_island || node != places_[i - 1].node) patches_.push_back({.begin = i});
    patches_.back().is_new |=
        node != nothing_moves && (at(contact) >= first_new || contacts[at(contact)].is_missed);
    patches_.back().has_boxes |= are_shifts || is_of_boxes(contacts[at(contact)]);
    ordered_.push_back(&impulses[at(contact)]);
    pushers_.push_back(pusher(contacts[at(contact)], impulses[at(contact)], are_shifts));
    patches_.back().is_pushed |= pushers_.back() >= 0;
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

/// The body on the side that no impulse moves, if it may push; or -1. Against shifts all do.
int SweptSolver::pusher(const SweptContact& contact, const SweptImpulse& impulse,
                        bool are_shifts) const {
  const auto pushes = [&](int body, const SweptSide& side) {
    return body != swept_ground && !side.moves() && (are_shifts || bodies_.pushes(body));
  };
  if (pushes(contact.first.body, impulse.first())) return contact.first.body;
  return pushes(contact.second.body, impulse.second()) ? contact.second.body : -1;
}

void SweptSolver::solve(std::span<const SweptContact> contacts, std::span<SweptImpulse> impulses,
                        double tolerance, std::size_t first_new) {
  solve_patches(contacts, impulses, tolerance, first_new, false);
}

bool SweptSolver::solve_shifts(std::span<const SweptContact> contacts,
                               std::span<SweptImpulse> impulses, double tolerance) {
  has_let_go_ = false;
  solve_patches(contacts, impulses, tolerance, 0, true);
  return !has_let_go_;
}

void SweptSolver::solve_patches(std::span<const SweptContact> contacts,
                                std::span<SweptImpulse> impulses, double tolerance,
                                std::size_t first_new, bool are_shifts) {
  divide(contacts, impulses, first_new, are_shifts);
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
  const auto& [begin, is_new, has_boxes, is_pushed] = patches_[patch];
  const std::size_t size = patches_[patch + 1].begin - begin;
  const std::span<SweptImpulse* const> impulses = std::span(ordered_).subspan(begin, size);
  if (has_boxes && is_pushed) {
    solve_pushed(impulses, std::span(pushers_).subspan(begin, size), tolerance);
  } else if (has_boxes) {
    solve_with_boxes(impulses, tolerance);
  } else {
    const std::span<const ImpulseNodes> nodes = std::span(nodes_).subspan(begin, size);
    gauss_seidel_.correct(impulses, nodes, tolerance, many_iterations);
  }
}

/// What is pressed by more than can be is let through, and keeps the room that there is.
void SweptSolver::solve_pushed(std::span<SweptImpulse* const> impulses,
                               std::span<const int> pushers, double tolerance) {
  const double enough = enough_for_all(impulses);
  if (enough == 0.0) {
    solve_with_boxes(impulses, tolerance);
    return;
  }
  for (std::size_t i = 0; i < impulses.size(); ++i) {
    if (pushers[i] >= 0) impulses[i]->limit(most_of_enough * enough);
  }
  for (int i = 0;; ++i) {
    double left = solve_with_boxes(impulses, tolerance);
    if (left > tolerance && any_pushes(impulses, pushers, few_of_enough * enough)) {
      left = iterations_.correct(tolerance_of_boxes * tolerance, more_iterations);
    }
    const double most = (left > tolerance ? most_of_unsolved : most_of_enough) * enough;
    if (i == max_let_go || !any_pushes(impulses, pushers, most)) return;
    let_go(impulses, pushers, most);
    for (SweptImpulse* impulse : impulses) impulse->replace_given(Vec4d{});
  }
}

/// N s, that would give all boxes and vertices the greatest speed that is missing.
double SweptSolver::enough_for_all(std::span<SweptImpulse* const> impulses) {
  double masses = 0.0, missing = 0.0;
  boxes_.clear();
  for (const SweptImpulse* impulse : impulses) {
    missing = std::max(missing, impulse->parting());
    for (const SweptSide* side : {&impulse->first(), &impulse->second()}) {
      if (side->box()) {
        boxes_.push_back(side->box());
      } else if (side->moves()) {
        masses += side->vertex_mass() * static_cast<double>(side->vertices().size());
      }
    }
  }
  std::ranges::sort(boxes_);
  boxes_.erase(std::unique(boxes_.begin(), boxes_.end()), boxes_.end());
  for (const BoxChange* box : boxes_) masses += 1.0 / box->inverse_mass;
  return masses * missing;
}

/// N s, of all contacts of the same two bodies.
double SweptSolver::push(std::span<SweptImpulse* const> impulses, std::span<const int> pushers,
                         std::size_t one) {
  double sum = 0.0;
  for (std::size_t i = 0; i < impulses.size(); ++i) {
    if (have_same_bodies(impulses, pushers, one, i))
      sum += impulses[i]->given().dot(impulses[i]->normal());
  }
  return sum;
}

bool SweptSolver::any_pushes(std::span<SweptImpulse* const> impulses, std::span<const int> pushers,
                             double most) {
  double sum = 0.0;
  for (std::size_t i = 0; i < impulses.size(); ++i) {
    if (pushers[i] >= 0) sum += impulses[i]->given().dot(impulses[i]->normal());
  }
  if (sum < most) return false;
  for (std::size_t i = 0; i < impulses.size(); ++i) {
    const bool pushes = pushers[i] >= 0 && !impulses[i]->given().isZero(0.0);
    if (pushes && push(impulses, pushers, i) >= most) return true;
  }
  return false;
}

/// Of each two bodies of which one does not give way and pushes with `most` (N s) or more, all
/// contacts.
void SweptSolver::let_go(std::span<SweptImpulse* const> impulses, std::span<const int> pushers,
                         double most) {
  has_let_go_ = true;
  for (std::size_t i = 0; i < impulses.size(); ++i) {
    if (pushers[i] < 0 || push(impulses, pushers, i) < most) continue;
    for (std::size_t other = 0; other < impulses.size(); ++other) {
      if (have_same_bodies(impulses, pushers, i, other)) impulses[other]->only_give_back();
    }
  }
}

/// Returns by how much the last correction changed a velocity. Where soft bodies bear boxes,
/// friction may not converge to the tolerance of boxes, and Newton's method costs as much as the
/// rest of the step: there the tolerance of all contacts will do. Boxes alone would lean by it.
double SweptSolver::solve_with_boxes(std::span<SweptImpulse* const> impulses, double tolerance) {
  const double of_boxes = tolerance_of_boxes * tolerance;
  iterations_.begin(impulses);
  double left = iterations_.correct(of_boxes, few_iterations);
  if (left <= of_boxes || (left <= tolerance && any_soft(impulses))) return left;
  int more = many_iterations - few_iterations;
  if (newton_.begin(impulses)) {
    if (improve(first_penalty, penalty_growth, of_boxes, left)) return left;
    if (left > unsolved * tolerance && have_different_masses(impulses)) {
      if (improve(least_penalty, least_growth, of_boxes, left)) return left;
      more = more_iterations;
    }
  }
  return iterations_.correct(of_boxes, more);
}

/// False if Newton's method does not converge. `left`: m/s, by how much a velocity changed at last.
bool SweptSolver::improve(double penalty, double growth, double tolerance, double& left) {
  for (; penalty < last_penalty; penalty *= growth) {
    if (!newton_.improve(penalty)) return false;
    left = iterations_.correct(tolerance, few_iterations);
    if (left <= tolerance) break;
  }
  return true;
}

}  // namespace pneuma::sim

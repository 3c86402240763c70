// Another search of the same step finds other candidates: the contacts that there are go over to
// them.
#include <algorithm>
#include <limits>
#include <tuple>

#include "sim/step/swept_search.h"

namespace pneuma::sim {
namespace {

auto name_of(const NearFeatures& features, bool is_of_near_boxes) {
  const auto& [first, second] = features;
  return std::tuple(is_of_near_boxes, first.kind, first.index, second.kind, second.index);
}

auto key_of(const SweptCandidate& candidate) {
  const auto [first, second] = candidate.bodies;
  return std::tuple(in_order(first, second),
                    name_of(candidate.features, candidate.is_of_near_boxes));
}

auto key_of(const SweptContact& contact) {
  const NearFeatures features{contact.first.feature, contact.second.feature};
  return std::tuple(in_order(contact.first.body, contact.second.body),
                    name_of(features, contact.is_of_near_boxes));
}

auto bodies_of(const SweptCandidate& candidate) {
  return in_order(candidate.bodies.first, candidate.bodies.second);
}

}  // namespace

/// The time is that of the candidates and contacts, times the logarithm of their number.
void SweptSearch::recall_contacts() {
  if (m_.contacts.empty()) return;
  list_recalled();
  const auto key = [&](const RecalledContact& one) { return key_of(m_.contacts[at(one.first)]); };
  for (SweptCandidate& candidate : m_.candidates) {
    const auto found = std::ranges::lower_bound(m_.recalled, key_of(candidate), {}, key);
    if (found == m_.recalled.end() || key(*found) != key_of(candidate)) continue;
    candidate.contact = found->last;
    found->is_found = true;
  }
  put_back_missing();
}

/// The contacts that the same features have made are one entry, sorted by their names.
void SweptSearch::list_recalled() {
  std::vector<RecalledContact>& all = m_.recalled;
  all.clear();
  m_.entry_of_contact.clear();
  for (int i = 0; i < static_cast<int>(m_.contacts.size()); ++i) {
    const int previous = m_.contacts[at(i)].previous;
    if (previous < 0) {
      m_.entry_of_contact.push_back(static_cast<int>(all.size()));
      all.push_back({i, i, false});
    } else {
      m_.entry_of_contact.push_back(m_.entry_of_contact[at(previous)]);
      all[at(m_.entry_of_contact.back())].last = i;
    }
  }
  std::ranges::sort(all, {},
                    [&](const RecalledContact& one) { return key_of(m_.contacts[at(one.first)]); });
}

/// What the search left out comes after the others of the same bodies, in the order in which it
/// came into contact.
void SweptSearch::put_back_missing() {
  std::erase_if(m_.recalled, &RecalledContact::is_found);
  const auto order = [&](const RecalledContact& one) {
    const SweptContact& contact = m_.contacts[at(one.first)];
    return std::tuple(in_order(contact.first.body, contact.second.body), one.first);
  };
  std::ranges::sort(m_.recalled, {}, order);
  std::size_t from = m_.candidates.size(), to = from + m_.recalled.size();
  m_.candidates.resize(to);
  for (std::size_t missing = m_.recalled.size(); missing-- > 0;) {
    const SweptCandidate back = missing_candidate(m_.recalled[missing]);
    while (from > 0 && bodies_of(m_.candidates[from - 1]) > bodies_of(back)) {
      m_.candidates[--to] = m_.candidates[--from];
    }
    m_.candidates[--to] = back;
  }
}

SweptCandidate SweptSearch::missing_candidate(const RecalledContact& recalled) const {
  const SweptContact& contact = m_.contacts[at(recalled.first)];
  SweptCandidate missing{{contact.first.body, contact.second.body},
                         {contact.first.feature, contact.second.feature},
                         {}};
  missing.contact = recalled.last;
  if (contact.is_of_near_boxes) {
    missing.is_of_near_boxes = true;
    missing.normal = contact.normal;
    missing.start.first_point = missing.start.second_point = contact.first.point;
    missing.start.distance = contact.distance;
  } else if (missing.bodies.second != swept_ground) {
    missing.start = *closest_points(bodies_.surface(missing.bodies.first),
                                    bodies_.surface(missing.bodies.second), missing.features,
                                    Moment::start, std::numeric_limits<double>::infinity());
  }
  return missing;
}

}  // namespace pneuma::sim

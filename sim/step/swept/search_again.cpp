// Other searches of the same step: what of an earlier one stays, and what is searched again beside
// obstacles of fine triangles, of which so many are near that only those are candidates that may
// touch as the ends now are. The contacts that there are go over to the candidates of another
// search.
#include <algorithm>
#include <limits>
#include <tuple>

#include "sim/step/swept/swept_search.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// Of the distance wanted: twice what features keep on their ways (SweptSearch::meets).
constexpr double least_of_wanted_beside = 0.1;
/// Sine of the angle up to which an edge of an obstacle leads no nearer: rounding.
constexpr double sine_of_nearest = 1e-6;

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

/// A soft body that may give way, and an obstacle that has finer features.
bool SweptSearch::is_beside_obstacle(const BodyPair& bodies) const {
  const auto [first, second] = bodies;
  const bool is_first = bodies_.is_obstacle(first);
  if (bodies_.is_rigid(second) || is_first == bodies_.is_obstacle(second)) return false;
  const double of_first = bodies_.surface(first).tree->mean_edge();
  const double of_second = bodies_.surface(second).tree->mean_edge();
  return is_first ? of_first < of_second : of_second < of_first;
}

/// Of a fine obstacle most of what is near could touch only if impulses let it: candidates are what
/// may touch as the ends are, and are searched again whenever these are others. At first, what is
/// nearest at the start: of what the free motion would go through, contacts need no more.
void SweptSearch::offer_beside_obstacle(const BodyPair& bodies, NearTriangles& near) {
  const auto [first, second] = bodies;
  const bool soft_is_first = !bodies_.is_obstacle(first);
  const int soft = soft_is_first ? first : second, obstacle = soft_is_first ? second : first;
  BesideObstacle pair =
      bodies_.beside_obstacle(soft, obstacle, motion_.near_distance(first, second),
                              least_of_wanted_beside * motion_.distance_wanted(first, second));
  pair.soft_is_first = soft_is_first;
  if (!near.is_known) m_.obstacle_search.find_near_triangles(pair, near.triangles);
  near.is_known = true;
  m_.found.clear();
  if (has_started_) {
    m_.obstacle_search.find_first_to_pass(pair, near.triangles, m_.found);
  } else {
    m_.obstacle_search.find_nearest_at_start(pair, near.triangles, m_.found);
  }
  are_beside_obstacles_ = true;
  for (const NearFeatures& features : m_.found) {
    bodies_.place_around(world_, start_, obstacle,
                         soft_is_first ? features.second : features.first);
    offer_beside_obstacle(bodies, features);
  }
}

void SweptSearch::offer_beside_obstacle(const BodyPair& bodies, const NearFeatures& features) {
  const auto [first, second] = bodies;
  const MovingSurface& a = bodies_.surface(first);
  const MovingSurface& b = bodies_.surface(second);
  const double reach = motion_.near_distance(first, second) + greatest_change(a, b, features);
  if (are_apart(a, b, features, reach)) return;
  const auto closest = closest_points(a, b, features, Moment::start, reach);
  if (!closest || !(has_started_ || obstacle_is_nearest(bodies, features, *closest))) return;
  m_.candidates.push_back({bodies, features, *closest});
}

/// Whether no edge of the obstacle leads nearer at the start, if it takes part by a vertex.
bool SweptSearch::obstacle_is_nearest(const BodyPair& bodies, const NearFeatures& features,
                                      const ClosestPoints& closest) const {
  const bool is_first = bodies_.is_obstacle(bodies.first);
  const Feature& feature = is_first ? features.first : features.second;
  return feature.kind != FeatureKind::vertex ||
         is_nearest_vertex(bodies_.surface(is_first ? bodies.first : bodies.second), feature.index,
                           is_first ? closest.second_point : closest.first_point, 0.0,
                           sine_of_nearest);
}

/// Those that are near while all ends are within their allowances are looked for once.
NearTriangles& SweptSearch::next_near_triangles() {
  if (next_near_ == m_.near_triangles.size()) m_.near_triangles.emplace_back();
  return m_.near_triangles[next_near_++];
}

/// The other candidates stay.
void SweptSearch::search_beside_obstacles() {
  std::swap(m_.candidates, m_.earlier_candidates);
  m_.candidates.clear();
  const std::vector<SweptCandidate>& earlier = m_.earlier_candidates;
  auto from = earlier.begin();
  next_near_ = 0;
  for (const BodyPair& pair : m_.near_bodies) {
    const auto end = std::find_if(from, earlier.end(),
                                  [&](const SweptCandidate& one) { return one.bodies != pair; });
    if (!is_beside_obstacle(pair) || !may_touch(pair)) {
      m_.candidates.insert(m_.candidates.end(), from, end);
    } else {
      const std::size_t before = m_.candidates.size();
      offer_beside_obstacle(pair, next_near_triangles());
      if (m_.candidates.size() != before) wake_if_touched(pair);
    }
    from = end;
  }
  m_.candidates.insert(m_.candidates.end(), from, earlier.end());
}

/// Of boxes whose ways still end where an earlier search of the step allowed for. Pairs are asked
/// for in the order of the candidates.
bool SweptSearch::keep_earlier(const BodyPair& bodies) {
  const std::vector<SweptCandidate>& earlier = m_.earlier_candidates;
  if (earlier.empty() || !bodies_.is_as_searched(bodies)) return false;
  const auto wanted = in_order(bodies.first, bodies.second);
  const auto next = [&] {
    const BodyPair& one = earlier[next_earlier_].bodies;
    return in_order(one.first, one.second);
  };
  while (next_earlier_ < earlier.size() && next() < wanted) ++next_earlier_;
  while (next_earlier_ < earlier.size() && next() == wanted) {
    m_.candidates.push_back(earlier[next_earlier_++]);
  }
  return true;
}

/// Candidates of an earlier search know their contacts.
bool SweptSearch::is_kept(const BodyPair& bodies) const {
  return bodies.second != swept_ground && bodies_.is_as_searched(bodies);
}

/// The time is that of the candidates and contacts, times the logarithm of their number.
void SweptSearch::recall_contacts() {
  if (m_.contacts.empty()) return;
  list_recalled();
  const auto key = [&](const RecalledContact& one) { return key_of(m_.contacts[at(one.first)]); };
  for (SweptCandidate& candidate : m_.candidates) {
    if (is_kept(candidate.bodies)) continue;
    const auto found = std::ranges::lower_bound(m_.recalled, key_of(candidate), {}, key);
    if (found == m_.recalled.end() || key(*found) != key_of(candidate)) continue;
    candidate.contact = found->last;
    found->is_found = true;
  }
  put_back_missing();
}

/// Contacts that the same features have made are one entry, sorted by their names. Contacts whose
/// candidates know them have none.
void SweptSearch::list_recalled() {
  std::vector<RecalledContact>& all = m_.recalled;
  all.clear();
  m_.entry_of_contact.clear();
  for (int i = 0; i < static_cast<int>(m_.contacts.size()); ++i) {
    const SweptContact& contact = m_.contacts[at(i)];
    const int previous = contact.previous;
    if (is_kept({contact.first.body, contact.second.body})) {
      m_.entry_of_contact.push_back(-1);
    } else if (previous < 0) {
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

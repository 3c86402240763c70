#include "sim/step/swept/swept_search.h"

#include <algorithm>

#include "sim/soft/pins.h"
#include "sim/step/swept/between_walls.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// What features keep of their distance on their way: of that at the start, and of that wanted.
constexpr double kept_of_start = 0.1;
constexpr double kept_of_wanted = 0.05;
/// Of the step: what boxes meet so soon after one another they meet at once.
constexpr double at_once = 0.01;

}  // namespace

void SweptSearch::start() {
  m_.contacts.clear();
  m_.impulses.clear();
  for (SweptCandidate& candidate : m_.candidates) {
    if (!is_seen_on_its_way(candidate)) add_if_it_meets(candidate);
  }
  has_started_ = true;
}

/// Features of what keeps its shape that are not near, or beside each other: a plane between them
/// as they lie at the start would brake what slides past. Whether they meet is seen once what bears
/// them holds them up.
bool SweptSearch::is_seen_on_its_way(const SweptCandidate& candidate) const {
  const auto [first, second] = candidate.bodies;
  if (second == swept_ground || candidate.is_of_near_boxes) return false;
  if (!bodies_.keep_shapes(candidate.bodies)) return false;
  return candidate.start.distance >= motion_.near_distance(first, second) ||
         places_.are_beside_each_other(candidate, candidate.start, Moment::start);
}

void SweptSearch::find_candidates() {
  has_started_ = has_looked_ = false;
  std::ranges::fill(m_.on_ground, OnGround{});
  m_.earlier_candidates.clear();
  search_ways();
}

void SweptSearch::search_ways() {
  m_.candidates.clear();
  are_beside_obstacles_ = false;
  // Implicit integrators keep volumes, which moves all vertices.
  const bool is_explicit = !is_implicit(world_.settings.integrator);
  for (std::size_t i = 0; i < m_.on_ground.size(); ++i) {
    m_.on_ground[i].meets_alone = is_explicit && !is_fixed(world_, static_cast<int>(i));
  }
  next_earlier_ = next_near_ = 0;
  for (NearTriangles& triangles : m_.near_triangles) triangles.is_known = false;
  bodies_.find_near_bodies(world_, start_, m_.near_bodies);
  for (const BodyPair& pair : m_.near_bodies) {
    if (!may_touch(pair)) continue;
    const std::size_t before = m_.candidates.size();
    if (is_beside_obstacle(pair)) {
      offer_beside_obstacle(pair, next_near_triangles());
      bodies_.may_meet(pair);
      // Candidates are what may touch as the ends are now, and no others.
      m_.on_ground[at(pair.first)].meets_alone = false;
      m_.on_ground[at(pair.second)].meets_alone = false;
    } else if (!keep_earlier(pair) && !offer_near_boxes(pair)) {
      offer_near_features(pair);
    }
    if (m_.candidates.size() == before) continue;
    bodies_.may_meet(pair);
    wake_if_touched(pair);
  }
  if (world_.settings.ground) find_near_ground();
}

void SweptSearch::wake_if_touched(const BodyPair& bodies) {
  for (const int body : {bodies.first, bodies.second}) {
    if (is_asleep(world_, body)) m_.touched_asleep.push_back(body);
  }
}

/// Of two bodies that no impulse moves one must sleep and the other come near it.
bool SweptSearch::may_touch(const BodyPair& bodies) const {
  const auto [first, second] = bodies;
  if (!is_fixed(world_, first) || !is_fixed(world_, second)) return true;
  const auto comes_near = [&](int body, int other) {
    return is_kinematic(world_, body) && bodies_.moves(world_, body) && is_asleep(world_, other);
  };
  return comes_near(first, second) || comes_near(second, first);
}

/// Only what may be in contact at the end of the step, wherever the allowances let it be. A way is
/// no longer than twice its allowance (SweptBodies), which says of most pairs that they are not.
void SweptSearch::offer_near_features(const BodyPair& bodies) {
  const auto [first, second] = bodies;
  bodies_.find_features(world_, start_, bodies, m_.found);
  const MovingSurface& a = bodies_.surface(first);
  const MovingSurface& b = bodies_.surface(second);
  const double touching = motion_.near_distance(first, second);
  const double allowed = bodies_.allowance(first) + bodies_.allowance(second);
  for (const NearFeatures& features : m_.found) {
    if (are_apart(a, b, features, touching + 3.0 * allowed)) continue;
    const double reach = touching + allowed + greatest_change(a, b, features);
    const auto closest = closest_points(a, b, features, Moment::start, reach);
    if (closest) m_.candidates.push_back({bodies, features, *closest});
  }
}

void SweptSearch::mark_candidates() {
  if (std::ranges::none_of(m_.on_ground, &OnGround::meets_alone)) return;
  std::ranges::fill(m_.is_in_candidate, std::uint8_t{0});
  const auto mark = [&](int body, const Feature& feature) {
    if (body == swept_ground) return;
    bodies_.for_each_node({body, feature}, [&](int node) { m_.is_in_candidate[at(node)] = 1; });
  };
  for (const SweptCandidate& candidate : m_.candidates) {
    mark(candidate.bodies.first, candidate.features.first);
    mark(candidate.bodies.second, candidate.features.second);
  }
}

/// Impulses keep from the ground what other impulses may move, and what would come so far below it
/// that it might not be put back onto it by itself.
void SweptSearch::find_near_ground() {
  mark_candidates();
  for (int i = 0; i < bodies_.count(); ++i) {
    if (bodies_.is_lone(i) || is_fixed(world_, i)) continue;
    const MovingSurface& surface = bodies_.surface(i);
    const double height = motion_.near_distance(i, swept_ground) + bodies_.allowance(i);
    const double deepest = -bodies_.allowance(i);
    const SoftBody* body = bodies_.is_rigid(i) ? nullptr : &world_.soft[at(i)];
    for (int v = 0; v < surface.start.size(); ++v) {
      if (body && is_pinned(*body, v)) continue;
      const double lowest = std::min(surface.start[v].z(), surface.end[v].z());
      if (lowest >= height) continue;
      if (body && lowest > deepest && is_alone(i, v)) continue;
      m_.candidates.push_back({{i, swept_ground}, {{FeatureKind::vertex, v}, {}}, {}});
    }
  }
}

void SweptSearch::follow_ends() {
  bodies_.set_end(world_);
  if (!bodies_.search_is_valid()) {
    m_.earlier_candidates = m_.candidates;
    search_ways();
  } else if (has_started_ && are_beside_obstacles_) {
    search_beside_obstacles();
  } else {
    return;
  }
  recall_contacts();
}

bool SweptSearch::find_collisions() {
  blocked_.reset();
  follow_ends();
  find_first_meetings();
  bool collided = false;
  const auto all = std::span(m_.candidates);
  for (std::size_t first = 0, end = 0; first < all.size(); first = end) {
    const BodyPair bodies = all[first].bodies;
    while (end < all.size() && all[end].bodies == bodies) ++end;
    collided = find_collisions_of_pair(all.subspan(first, end - first)) || collided;
  }
  has_looked_ = true;
  return collided;
}

bool SweptSearch::find_missed() {
  bool any = false;
  for (std::size_t i = 0; i < m_.contacts.size(); ++i) {
    SweptContact& contact = m_.contacts[i];
    if (contact.second.body == swept_ground || contact.is_near) continue;
    if (!bodies_.keep_shapes(pair_of(contact))) continue;
    const double left = contact.distance + contact.normal.dot(motion_.displacement(contact));
    contact.is_missed = m_.impulses[i].normal_impulse() > 0.0 &&
                        left > motion_.near_distance(contact.first.body, contact.second.body);
    any = any || contact.is_missed;
  }
  return any;
}

/// Finds when each box first meets something that stands still: held there, it may not meet what it
/// would later. A box that falls onto tiles, and is held by their tops, comes to none of their
/// sides.
void SweptSearch::find_first_meetings() {
  if (has_looked_ || std::ranges::none_of(world_.rigid, &RigidBox::is_kinematic)) return;
  m_.first_meeting.assign(world_.rigid.size(), 1.0);
  for (const SweptCandidate& candidate : m_.candidates) {
    const int box = box_beside_still(candidate.bodies);
    if (box < 0 || candidate.is_of_near_boxes) continue;
    if (const auto fraction = fraction_of_meeting(candidate)) {
      double& earliest = m_.first_meeting[at(box)];
      earliest = std::min(earliest, *fraction);
    }
  }
}

/// Whether its box meets something else before: that is held first, and the next search looks
/// again.
bool SweptSearch::comes_later(const SweptCandidate& candidate, double fraction) const {
  const int box = has_looked_ ? -1 : box_beside_still(candidate.bodies);
  return box >= 0 && fraction > m_.first_meeting[at(box)] + at_once;
}

/// The number of a box that is free, and of which the other of two boxes stands still; or -1.
int SweptSearch::box_beside_still(const BodyPair& bodies) const {
  const auto [first, second] = bodies;
  if (second == swept_ground || !bodies_.is_box(first) || !bodies_.is_box(second)) return -1;
  if (is_fixed(world_, first) == is_fixed(world_, second)) return -1;
  const int free = is_fixed(world_, first) ? second : first;
  return bodies_.stands_still(world_, free == first ? second : first) ? bodies_.box(free) : -1;
}

bool SweptSearch::find_collisions_of_pair(std::span<SweptCandidate> candidates) {
  bool collided = false;
  m_.meetings.clear();
  const std::size_t before = m_.contacts.size();
  for (SweptCandidate& candidate : candidates) {
    const bool on_ground = candidate.bodies.second == swept_ground;
    collided = (on_ground ? goes_into_ground(candidate) : meets(candidate)) || collided;
  }
  if (m_.contacts.size() == before) hold_where_they_meet();
  return collided;
}

/// What was placed at the start does not keep these apart: other features were nearest then, or
/// the direction turns on the way. Without another contact the next round would do nothing. Of a
/// box that stands still, what meets first is held: edges that a soft body would meet below its
/// faces it then passes.
void SweptSearch::hold_where_they_meet() {
  if (m_.meetings.empty()) return;
  const BodyPair& bodies = m_.candidates[at(m_.meetings.front().candidate)].bodies;  // of all
  const bool is_at_still_box = places_.are_soft_and_still_box(bodies);
  const double last = is_at_still_box
                          ? std::ranges::min(m_.meetings, {}, &Meeting::fraction).fraction + at_once
                          : 1.0;
  for (const auto& [candidate, fraction] : m_.meetings) {
    if (fraction > last) continue;
    SweptCandidate& meeting = m_.candidates[at(candidate)];
    const SweptContact contact = is_at_still_box || meeting.contact >= 0
                                     ? places_.place_along_line(meeting, fraction)
                                     : places_.place(meeting, meeting.start, Moment::start);
    if (motion_.is_moved(contact)) add(meeting, contact);
  }
}

/// The fraction of the step after which two features come too near each other on their ways.
std::optional<double> SweptSearch::fraction_of_meeting(const SweptCandidate& candidate) const {
  const auto [first, second] = candidate.bodies;
  const double distance = candidate.start.distance;
  // What touches at the start is held from there.
  if (distance < rounding_distance) return std::nullopt;
  const double least =
      std::min(kept_of_start * distance, kept_of_wanted * motion_.distance_wanted(first, second));
  const auto meeting = [&](double kept) {
    return time_of_meeting(bodies_.surface(candidate.bodies.first),
                           bodies_.surface(candidate.bodies.second), candidate.features, distance,
                           kept);
  };
  auto fraction = meeting(least);
  if (fraction && places_.are_soft_and_still_box(candidate.bodies)) {
    // What slides over a face keeps no more from the next one than from that.
    const double kept = kept_of_start * places_.height_over_still_boxes(candidate);
    if (kept > 0.0 && kept < least) fraction = meeting(kept);
  }
  return fraction && slide_past_each_other(candidate.bodies) ? std::nullopt : fraction;
}

/// Whether two features come too near each other on their ways. It becomes a contact: of what keeps
/// its shape as it meets, since it may come far or turn until then, and from beside a face onto it;
/// of others as they are at the start.
bool SweptSearch::meets(SweptCandidate& candidate) {
  if (candidate.is_of_near_boxes) return sinks_in(candidate);
  const auto fraction = fraction_of_meeting(candidate);
  if (!fraction || !motion_.is_moved(places_.place(candidate, candidate.start, Moment::start)))
    return false;
  blocked_ = candidate.bodies;
  if (comes_later(candidate, *fraction)) return true;
  // What it is over holds it first.
  if (!has_looked_ && places_.is_over_flush_box(candidate, candidate.start)) return true;
  m_.meetings.push_back({static_cast<int>(&candidate - m_.candidates.data()), *fraction});
  if (bodies_.keep_shapes(candidate.bodies) || places_.are_soft_and_still_box(candidate.bodies)) {
    if (places_.stands_where_it_meets(candidate, *fraction))
      add(candidate, places_.place_at(candidate, *fraction));
  } else if (candidate.contact < 0 && places_.stands(candidate, candidate.start, Moment::start)) {
    add(candidate, places_.place(candidate, candidate.start, Moment::start));
  }
  return true;
}

/// A vertex that other impulses pushed, and that was not yet held up; or one of a box that is held
/// up as if it moved along a line, and turns.
bool SweptSearch::goes_into_ground(SweptCandidate& candidate) {
  const MovingSurface& surface = bodies_.surface(candidate.bodies.first);
  const double height = surface.end[candidate.features.first.index].z();
  if (candidate.contact >= 0) {
    SweptContact& contact = m_.contacts[at(candidate.contact)];
    contact.is_missed = motion_.is_rigid(contact) &&
                        height < std::min(0.0, contact.distance) - bodies_.skin(contact.first.body);
    return contact.is_missed;
  }
  if (height >= -motion_.near_distance(candidate.bodies.first, swept_ground)) return false;
  blocked_ = candidate.bodies;
  return add_if_it_meets(candidate);
}

bool SweptSearch::add_if_it_meets(SweptCandidate& candidate) {
  const auto [first, second] = candidate.bodies;
  const SweptContact contact = second == swept_ground
                                   ? places_.place_on_ground(candidate, Moment::start)
                                   : places_.place(candidate, candidate.start, Moment::start);
  if (contact.distance + contact.normal.dot(motion_.displacement(contact)) >
      motion_.near_distance(first, second))
    return false;
  if (second != swept_ground && !places_.stands(candidate, candidate.start, Moment::start))
    return false;
  if (!motion_.is_moved(contact)) return false;
  add(candidate, contact);
  return true;
}

void SweptSearch::add(SweptCandidate& candidate, SweptContact contact) {
  contact.previous = candidate.contact;
  candidate.contact = static_cast<int>(m_.contacts.size());
  // What is still on its way does not rub.
  m_.impulses.push_back(
      motion_.impulse(contact, contact.is_near ? motion_.material(contact).friction : 0.0));
  squeeze_between_walls(world_, m_, time_step(world_.settings), contact, m_.impulses.back());
  motion_.find_approach(contact, m_.impulses.back().change());
  m_.contacts.push_back(contact);
}

}  // namespace pneuma::sim

// The part of SweptSearch that sees two boxes near each other as boxes, not by their features.
#include <algorithm>

#include "sim/collision/box_contact.h"
#include "sim/step/swept_search.h"

namespace pneuma::sim {
namespace {

/// Of the shorter of their shortest sides: boxes no further apart at the start of the step touch in
/// the points of one contact, as boxes, and not by their features.
constexpr double near_of_side = 0.02;

double reach_of(const OrientedBox& one, const OrientedBox& other) {
  return near_of_side * 2.0 * std::min(one.half.minCoeff(), other.half.minCoeff());
}

}  // namespace

OrientedBox SweptSearch::end_box(int body) const {
  const RigidBox& box = world_.rigid[at(bodies_.box(body))];
  return {box.position, box.orientation.toRotationMatrix(), 0.5 * box.size};
}

OrientedBox SweptSearch::start_box(int body) const {
  const RigidStart& start = start_.rigid[at(bodies_.box(body))];
  return {start.position, start.orientation.toRotationMatrix(),
          0.5 * world_.rigid[at(bodies_.box(body))].size};
}

/// m, of a corner of one box against one of another, at most: the same motion of both is left out.
double SweptSearch::greatest_relative_way(int first, int second) const {
  const auto way = [&](int body, int corner) {
    const MovingSurface& surface = bodies_.surface(body);
    return Vec3(surface.end[corner] - surface.start[corner]);
  };
  constexpr int corners = 8;
  Vec3 mean = Vec3::Zero();
  for (int i = 0; i < corners; ++i) mean += (way(first, i) + way(second, i)) / (2.0 * corners);
  double of_first = 0.0, of_second = 0.0;
  for (int i = 0; i < corners; ++i) {
    of_first = std::max(of_first, (way(first, i) - mean).norm());
    of_second = std::max(of_second, (way(second, i) - mean).norm());
  }
  return of_first + of_second;
}

/// Whether the bodies are boxes that lie in each other, or are near each other and stay so: their
/// contact says how deep they lie in each other, which features that have passed through each other
/// cannot.
bool SweptSearch::offer_near_boxes(const BodyPair& bodies) {
  const auto [first, second] = bodies;
  if (!bodies_.is_rigid(first) || !bodies_.is_rigid(second)) return false;
  const OrientedBox one = start_box(first), other = start_box(second);
  const double near_boxes = reach_of(one, other);
  const auto contact = find_box_contact_within(near_boxes, one, other);
  if (!contact) return false;
  if (contact->depth < 0.0 && greatest_relative_way(first, second) > near_boxes) return false;
  for (int i = 0; i < contact->count; ++i) {
    const auto& [point, depth] = contact->all[at(i)];
    const Feature number{FeatureKind::vertex, i};
    SweptCandidate candidate{bodies, {number, number}};
    candidate.start.first_point = candidate.start.second_point = point;
    candidate.start.distance = -depth;
    candidate.is_of_near_boxes = true;
    candidate.normal = contact->normal;
    m_.candidates.push_back(candidate);
  }
  return true;
}

/// Whether boxes that touch turn or slide far into each other in the step: what the points of their
/// contact at its start do not see. A shorter step does.
bool SweptSearch::turn_into_each_other(const BodyPair& bodies) const {
  const auto [first, second] = bodies;
  const OrientedBox one = start_box(first), other = start_box(second);
  const double near_boxes = reach_of(one, other);
  if (greatest_relative_way(first, second) <= near_boxes) return false;
  const auto before = find_box_contact_within(near_boxes, one, other);
  const auto after = find_box_contact(end_box(first), end_box(second));
  return after && after->depth > (before ? std::max(0.0, before->depth) : 0.0) + near_boxes;
}

/// Boxes that others push into each other, further than they were.
bool SweptSearch::sinks_in(SweptCandidate& candidate) {
  const auto [first, second] = candidate.bodies;
  const bool is_first_point = candidate.features.first.index == 0;
  if (is_first_point && turn_into_each_other(candidate.bodies)) {
    blocked_ = candidate.bodies;
    return true;
  }
  const double least = std::min(0.0, candidate.start.distance) - distance_wanted(first, second);
  if (move_to_end(candidate).distance >= least) return false;
  if (candidate.contact < 0) add(candidate, place(candidate, candidate.start, Moment::start));
  return true;
}

/// The points of near boxes go with them, and their normal is that of the start.
SweptContact SweptSearch::move_to_end(const SweptCandidate& candidate) const {
  SweptContact contact = place(candidate, candidate.start, Moment::start);
  const Vec3 of_first = bodies_.displacement(world_, start_, contact.first);
  const Vec3 of_second = bodies_.displacement(world_, start_, contact.second);
  contact.distance += contact.normal.dot(of_first - of_second);
  contact.is_near = contact.distance < near_distance(contact.first.body, contact.second.body);
  contact.first.point += of_first;
  contact.second.point += of_second;
  meet_halfway(contact.first, contact.second);
  return contact;
}

void SweptSearch::find_contacts_of_boxes() {
  m_.contacts.clear();
  m_.impulses.clear();
  for (const SweptCandidate& candidate : m_.candidates) {
    const auto [first, second] = candidate.bodies;
    const bool on_ground = second == swept_ground && bodies_.is_rigid(first);
    if (!candidate.is_of_near_boxes && !on_ground) continue;
    m_.contacts.push_back(on_ground ? place_on_ground(candidate, Moment::start)
                                    : place(candidate, candidate.start, Moment::start));
    m_.impulses.push_back(impulse(m_.contacts.back(), 0.0));
  }
}

}  // namespace pneuma::sim

// The part of SweptSearch that sees two boxes near each other as boxes, not by their features.
#include <algorithm>
#include <array>
#include <cmath>

#include "sim/collision/box_contact.h"
#include "sim/collision/separating_axis.h"
#include "sim/step/swept/shift_boxes.h"
#include "sim/step/swept/swept_search.h"

namespace pneuma::sim {
namespace {

/// Of the distance wanted: further than this boxes do not get into each other in a step.
constexpr double allowed_sinking = 0.1;
/// Of the distance wanted: boxes on one plane are no further below each other's faces.
constexpr double level = 5e-3;

double reach_of(const OrientedBox& one, const OrientedBox& other) {
  return near_of_side * 2.0 * std::min(one.half.minCoeff(), other.half.minCoeff());
}

/// m, of another box's lowest corner over the face on one side of the axis.
double height_over(const OrientedBox& box, int axis, double sign, const OrientedBox& other) {
  const Vec3 outward = sign * box.axes.col(axis);
  return outward.dot(other.centre - box.centre) - box.half[axis] - radius_along(other, outward);
}

}  // namespace

/// m, of a corner of one box against one of another, at most: the same motion of both is left out.
double SweptSearch::greatest_relative_way(int first, int second) const {
  constexpr std::size_t corners = 8;
  using Ways = std::array<Vec4d, corners>;
  Vec4d mean{};
  const auto ways_of = [&](int body) {
    const VertexReader start(bodies_.surface(body).start), end(bodies_.surface(body).end);
    Ways ways;
    for (std::size_t i = 0; i < corners; ++i) {
      ways[i] = end[static_cast<int>(i)] - start[static_cast<int>(i)];
      mean += 1.0 / (2.0 * corners) * ways[i];
    }
    return ways;
  };
  const Ways of_first = ways_of(first), of_second = ways_of(second);
  const auto greatest = [&](const Ways& ways) {
    double squared = 0.0;
    for (const Vec4d way : ways) squared = std::max(squared, dot(way - mean, way - mean));
    return std::sqrt(squared);
  };
  return greatest(of_first) + greatest(of_second);
}

/// Boxes that are too far apart to touch, and too slow.
bool SweptSearch::stay_apart(const BodyPair& bodies, const OrientedBox& one,
                             const OrientedBox& other) const {
  const auto [first, second] = bodies;
  const double reach = motion_.near_distance(first, second) + bodies_.allowance(first) +
                       bodies_.allowance(second) + greatest_relative_way(first, second);
  return !find_min_overlap(one, other, reach);
}

/// Whether the bodies are boxes that lie in each other, or are near each other and stay so: their
/// contact says how deep they lie in each other, which features that have passed through each other
/// cannot. Nothing is offered of boxes that stay apart.
bool SweptSearch::offer_near_boxes(const BodyPair& bodies) {
  const auto [first, second] = bodies;
  if (!bodies_.is_rigid(first) || !bodies_.is_rigid(second)) return false;
  const OrientedBox one = places_.start_box(first), other = places_.start_box(second);
  const double near_boxes = reach_of(one, other);
  const auto contact = find_box_contact_within(near_boxes, one, other);
  if (!contact) return stay_apart(bodies, one, other);
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

/// Whether one box goes along a face of the other, comes no nearer to it, and is no further below
/// it than boxes on one plane are: their edges pass, and meet nowhere. Over a face that does not
/// turn, what goes along straight lines is lowest at their ends.
bool SweptSearch::slide_past_each_other(const BodyPair& bodies) const {
  const auto [first, second] = bodies;
  if (!bodies_.is_box(first) || !bodies_.is_box(second)) return false;
  const double allowed = level * motion_.distance_wanted(first, second);
  const auto keeps_apart = [&](int with_face, int other) {
    const OrientedBox start = places_.start_box(with_face), end = places_.end_box(with_face);
    const OrientedBox from = places_.start_box(other), to = places_.end_box(other);
    const double reach = (from.centre - start.centre).norm() + from.half.norm();
    if (reach * (end.axes - start.axes).norm() > allowed) return false;
    for (const double sign : {1.0, -1.0}) {
      for (int axis = 0; axis < 3; ++axis) {
        const double before = height_over(start, axis, sign, from);
        const double after = height_over(end, axis, sign, to);
        if (after >= -allowed && std::abs(after - before) <= allowed) return true;
      }
    }
    return false;
  };
  return keeps_apart(first, second) || keeps_apart(second, first);
}

/// Boxes that turn or slide into each other, which the points of their contact at the start of the
/// step do not see: they are held where they would be in each other at its end. What goes far needs
/// a shorter step.
bool SweptSearch::turn_into_each_other(SweptCandidate& first_point) {
  const auto [first, second] = first_point.bodies;
  const double allowed = allowed_sinking * motion_.distance_wanted(first, second);
  if (greatest_relative_way(first, second) <= allowed) return false;
  const auto after = find_box_contact(places_.end_box(first), places_.end_box(second));
  if (!after || after->depth <= allowed) return false;
  const OrientedBox one = places_.start_box(first), other = places_.start_box(second);
  const double near_boxes = reach_of(one, other);
  const auto before = find_box_contact_within(near_boxes, one, other);
  const double sinks = after->depth - (before ? std::max(0.0, before->depth) : 0.0);
  if (sinks <= allowed) return false;
  if (sinks > near_boxes) blocked_ = first_point.bodies;
  for (const BoxContactPoint& point : after->points()) {
    add(first_point, places_.place_before_end(first_point, after->normal, point));
  }
  return true;
}

/// Boxes that turn, or that others push, into each other, further than they were.
bool SweptSearch::sinks_in(SweptCandidate& candidate) {
  const auto [first, second] = candidate.bodies;
  const bool is_first_point = candidate.features.first.index == 0;
  if (is_first_point && turn_into_each_other(candidate)) return true;
  const double least = std::min(0.0, candidate.start.distance) -
                       allowed_sinking * motion_.distance_wanted(first, second);
  if (places_.move_to_end(candidate).distance >= least) return false;
  if (candidate.contact < 0)
    add(candidate, places_.place(candidate, candidate.start, Moment::start));
  return true;
}

/// Boxes that pass each other by single features are not shifted, and what is squeezed has nowhere
/// to go.
template <class Visit>
void SweptSearch::for_each_of_boxes(const Visit& visit) const {
  for (const SweptCandidate& candidate : m_.candidates) {
    const auto [first, second] = candidate.bodies;
    const bool on_ground = second == swept_ground;
    if (!bodies_.keep_shapes(candidate.bodies)) continue;
    const bool are_boxes = !on_ground && bodies_.is_rigid(first) && bodies_.is_rigid(second);
    if ((are_boxes && !candidate.is_of_near_boxes) || is_squeezed(candidate)) continue;
    const double wanted = motion_.distance_wanted(first, second);
    const double kept = kept_between_walls(candidate, wanted).value_or(closest_allowed * wanted);
    visit(candidate, kept - places_.start_distance(candidate));
  }
}

double SweptSearch::greatest_missing_of_boxes() const {
  double greatest = 0.0;
  for_each_of_boxes(
      [&](const SweptCandidate&, double missing) { greatest = std::max(greatest, missing); });
  return greatest;
}

void SweptSearch::find_contacts_of_boxes(double room) {
  m_.contacts.clear();
  for_each_of_boxes([&](const SweptCandidate& candidate, double missing) {
    if (missing < -room) return;
    const bool on_ground = candidate.bodies.second == swept_ground;
    if (!on_ground && !places_.stands(candidate, candidate.start, Moment::start)) return;
    m_.contacts.push_back(on_ground ? places_.place_on_ground(candidate, Moment::start)
                                    : places_.place(candidate, candidate.start, Moment::start));
  });
}

/// Of soft bodies the side does not give way: they are not shifted.
void SweptSearch::find_contacts_beside_boxes(double reach) {
  for (const SweptCandidate& candidate : m_.candidates) {
    const auto [first, second] = candidate.bodies;
    if (second == swept_ground || bodies_.is_rigid(first) == bodies_.is_rigid(second)) continue;
    if (bodies_.is_obstacle(bodies_.is_rigid(first) ? second : first)) continue;
    if (candidate.start.distance >= motion_.distance_wanted(first, second) + reach) continue;
    if (!places_.stands(candidate, candidate.start, Moment::start)) continue;
    const SweptContact contact = places_.place(candidate, candidate.start, Moment::start);
    const auto side = [&](const SurfacePoint& point) {
      return bodies_.is_rigid(point.body) ? bodies_.side(world_, point) : SweptSide();
    };
    m_.contacts.push_back(contact);
    m_.impulses.push_back({side(contact.first), side(contact.second), contact.normal, 0.0});
  }
}

}  // namespace pneuma::sim

#include "sim/step/swept/contact_places.h"

#include <algorithm>
#include <limits>

namespace pneuma::sim {
namespace {

/// Sine of the angle between faces that lie on each other: rounding; but a box with one contact for
/// each of its faces would rock on what is soft.
constexpr double flat = 1e-6, flat_of_boxes = 0.03;
constexpr double cosine_of_flat = 1.0 - 0.5 * flat_of_boxes * flat_of_boxes;
constexpr double any_distance = std::numeric_limits<double>::infinity();

}  // namespace

OrientedBox ContactPlaces::end_box(int body) const {
  const RigidBox& box = world_.rigid[at(bodies_.box(body))];
  return {box.position, bodies_.end_axes(body), 0.5 * box.size};
}

OrientedBox ContactPlaces::start_box(int body) const {
  const RigidState& start = start_.rigid[at(bodies_.box(body))];
  return {start.position, bodies_.start_axes(body), 0.5 * world_.rigid[at(bodies_.box(body))].size};
}

SweptContact ContactPlaces::place_on_ground(const SweptCandidate& candidate, Moment moment) const {
  const int body = candidate.bodies.first;
  const Feature& vertex = candidate.features.first;
  const MovingSurface& surface = bodies_.surface(body);
  const Vec3 point =
      moment == Moment::start ? surface.start[vertex.index] : surface.end[vertex.index];
  return {.first = {body, vertex, {1.0, 0.0, 0.0}, point},
          .second = {swept_ground, {}, {}, point},
          .normal = Vec3::UnitZ(),
          .distance = point.z(),
          .wanted = 0.0,
          .is_near = point.z() < motion_.near_distance(body, swept_ground)};
}

SweptContact ContactPlaces::place(const SweptCandidate& candidate, const ClosestPoints& closest,
                                  Moment moment) const {
  const auto [first, second] = candidate.bodies;
  const auto& [of_first, of_second] = candidate.features;
  const double wanted = motion_.distance_wanted(first, second);
  SweptContact contact = {
      .first = {first, of_first, closest.first_weights, closest.first_point},
      .second = {second, of_second, closest.second_weights, closest.second_point},
      .normal = normal_of(candidate, closest, moment),
      .distance = closest.distance,
      .wanted = wanted,
      .is_near = closest.distance < ContactMotion::near_distance(wanted)};
  contact.is_of_near_boxes = candidate.is_of_near_boxes;
  if (motion_.is_rigid(contact)) meet_halfway(contact.first, contact.second);
  return contact;
}

/// Between points that touch there is no direction: of boxes it is the one in which they are
/// furthest apart, of others that of the features.
Vec3 ContactPlaces::normal_of(const SweptCandidate& candidate, const ClosestPoints& closest,
                              Moment moment) const {
  if (candidate.is_of_near_boxes) return candidate.normal;
  if (closest.distance >= rounding_distance) {
    return (closest.first_point - closest.second_point).normalized();
  }
  const MovingSurface& a = bodies_.surface(candidate.bodies.first);
  const MovingSurface& b = bodies_.surface(candidate.bodies.second);
  const bool are_boxes =
      bodies_.is_rigid(candidate.bodies.first) && bodies_.is_rigid(candidate.bodies.second);
  return are_boxes ? direction_apart(a, b, moment)
                   : touching_normal(a, b, candidate.features, moment);
}

Vec3 ContactPlaces::start_normal(const SweptCandidate& candidate) const {
  return candidate.bodies.second == swept_ground
             ? Vec3::UnitZ()
             : normal_of(candidate, candidate.start, Moment::start);
}

double ContactPlaces::start_distance(const SweptCandidate& candidate) const {
  const auto [first, second] = candidate.bodies;
  return second == swept_ground ? bodies_.surface(first).start[candidate.features.first.index].z()
                                : candidate.start.distance;
}

bool ContactPlaces::stands(const SweptCandidate& candidate, const ClosestPoints& closest,
                           Moment moment) const {
  return candidate.is_of_near_boxes || stands(candidate, closest, fraction_at(moment));
}

bool ContactPlaces::stands_where_it_meets(const SweptCandidate& candidate, double fraction) const {
  const auto [first, second] = candidate.bodies;
  if (bodies_.is_box(first) && bodies_.is_box(second)) return true;
  const ClosestPoints closest = closest_points_at(bodies_.surface(first), bodies_.surface(second),
                                                  candidate.features, fraction);
  return stands(candidate, closest, fraction) && !is_in_still_box(candidate, closest);
}

bool ContactPlaces::stands(const SweptCandidate& candidate, const ClosestPoints& closest,
                           double fraction) const {
  const auto [first, second] = candidate.bodies;
  const bool has_box = bodies_.is_rigid(first) || bodies_.is_rigid(second);
  const double sine_of_flat = has_box ? flat_of_boxes : flat;
  return stands_for_its_parts(bodies_.surface(first), bodies_.surface(second), candidate.features,
                              closest, fraction, sine_of_flat) &&
         obstacle_is_nearest(candidate, closest, fraction, sine_of_flat) &&
         !is_over_flush_box(candidate, closest);
}

/// A vertex in the flat of an obstacle has faces beside it that a tilted triangle is nearer to: the
/// triangle's normal there would brake what slides.
bool ContactPlaces::obstacle_is_nearest(const SweptCandidate& candidate,
                                        const ClosestPoints& closest, double fraction,
                                        double sine_of_flat) const {
  const auto is_nearest = [&](int body, const Feature& feature, const Vec3& point) {
    return !bodies_.is_obstacle(body) || feature.kind != FeatureKind::vertex ||
           is_nearest_vertex(bodies_.surface(body), feature.index, point, fraction, sine_of_flat);
  };
  const auto [first, second] = candidate.bodies;
  return is_nearest(first, candidate.features.first, closest.second_point) &&
         is_nearest(second, candidate.features.second, closest.first_point);
}

/// Boxes are of which no face is towards the other. Of boxes that are apart so are features that
/// are nearest in another direction than across the faces; in boxes that overlap that direction may
/// change, where the overlap is as small along another.
bool ContactPlaces::boxes_are_beside(const SweptCandidate& candidate, const ClosestPoints& closest,
                                     Moment moment) const {
  const auto [first, second] = candidate.bodies;
  const auto box = [&](int i) { return moment == Moment::start ? start_box(i) : end_box(i); };
  const double near = motion_.near_distance(first, second);
  const auto contact = find_box_contact_within(near, box(first), box(second));
  if (!contact) return true;
  if (contact->depth >= 0.0) return vertices_are_beside(candidate, closest, moment);
  const Vec3 apart = (closest.first_point - closest.second_point) / closest.distance;
  const double across = contact->normal.dot(apart);
  return across < 0.0 || (apart - across * contact->normal).norm() > flat_of_boxes;
}

/// Of vertices that are not what of their bodies is nearest.
bool ContactPlaces::vertices_are_beside(const SweptCandidate& candidate,
                                        const ClosestPoints& closest, Moment moment) const {
  const auto is_beside = [&](int body, const Feature& feature, const Vec3& point) {
    return feature.kind == FeatureKind::vertex &&
           !is_nearest_vertex(bodies_.surface(body), feature.index, point, fraction_at(moment),
                              flat_of_boxes);
  };
  const auto [first, second] = candidate.bodies;
  return is_beside(first, candidate.features.first, closest.second_point) ||
         is_beside(second, candidate.features.second, closest.first_point);
}

bool ContactPlaces::are_beside_each_other(const SweptCandidate& candidate,
                                          const ClosestPoints& closest, Moment moment) const {
  const auto [first, second] = candidate.bodies;
  if (bodies_.is_box(first) && bodies_.is_box(second)) {
    return boxes_are_beside(candidate, closest, moment);
  }
  const bool is_beside_obstacle = (bodies_.is_box(first) && bodies_.is_obstacle(second)) ||
                                  (bodies_.is_obstacle(first) && bodies_.is_box(second));
  return is_beside_obstacle && (vertices_are_beside(candidate, closest, moment) ||
                                passes_rim(candidate, closest, moment));
}

/// Whether a corner or an edge is nearest to an edge along it: what fits into a hole passes that
/// so, and touches what it lies on with a corner on a face, or with edges that cross.
bool ContactPlaces::passes_rim(const SweptCandidate& candidate, const ClosestPoints& closest,
                               Moment moment) const {
  if (closest.distance < rounding_distance) return false;
  const MovingSurface& a = bodies_.surface(candidate.bodies.first);
  const MovingSurface& b = bodies_.surface(candidate.bodies.second);
  const auto& [of_first, of_second] = candidate.features;
  const Vec3 apart = (closest.first_point - closest.second_point) / closest.distance;
  if (of_first.kind == FeatureKind::edge) {
    if (sine_between_edges(a, b, candidate.features, moment) > flat_of_boxes) return false;
    const int box =
        bodies_.is_box(candidate.bodies.first) ? candidate.bodies.first : candidate.bodies.second;
    const OrientedBox placed = moment == Moment::start ? start_box(box) : end_box(box);
    return (placed.axes.transpose() * apart).cwiseAbs().maxCoeff() < cosine_of_flat;
  }
  return apart.cross(touching_normal(a, b, candidate.features, moment)).norm() > flat_of_boxes;
}

/// At the start, as points that are nearest after a fraction of the step.
SweptContact ContactPlaces::place_at(const SweptCandidate& candidate, double fraction) const {
  const MovingSurface& a = bodies_.surface(candidate.bodies.first);
  const MovingSurface& b = bodies_.surface(candidate.bodies.second);
  SweptContact contact =
      place(candidate, closest_points_at(a, b, candidate.features, fraction), Moment::start);
  contact.first.point = bodies_.start_point(contact.first);
  contact.second.point = bodies_.start_point(contact.second);
  contact.distance = contact.normal.dot(contact.first.point - contact.second.point);
  contact.wanted = std::min(contact.wanted, contact.distance);  // nothing is pushed along this line
  contact.is_near =
      candidate.start.distance < motion_.near_distance(contact.first.body, contact.second.body);
  return contact;
}

/// The points that meet after a fraction of the step are kept apart along the line through them at
/// its start: along no other would the impulse keep angular momentum. A side that impulses do not
/// move takes up any: beside it they are kept apart in the direction in which they meet, or what
/// slides would be braked.
SweptContact ContactPlaces::place_along_line(const SweptCandidate& candidate,
                                             double fraction) const {
  SweptContact contact = place_at(candidate, fraction);
  const bool both_move =
      bodies_.side(world_, contact.first).moves() && bodies_.side(world_, contact.second).moves();
  if (!both_move) return contact;
  const Vec3 apart = contact.first.point - contact.second.point;
  contact.distance = apart.norm();
  if (contact.distance >= rounding_distance) contact.normal = apart / contact.distance;
  contact.wanted =
      std::min(motion_.distance_wanted(contact.first.body, contact.second.body), contact.distance);
  return contact;
}

std::optional<SweptContact> ContactPlaces::place_at_end(const SweptCandidate& candidate,
                                                        const SweptContact* acted) const {
  const auto [first, second] = candidate.bodies;
  return place_at_end(candidate, acted,
                      acted ? any_distance : motion_.near_distance(first, second));
}

std::optional<SweptContact> ContactPlaces::place_beside_hit(const SweptCandidate& candidate) const {
  const auto [first, second] = candidate.bodies;
  const double near = motion_.near_distance(first, second);
  auto contact = place_at_end(candidate, nullptr, near + hit_together * bodies_.skin(first));
  if (!contact || contact->distance < near) return std::nullopt;
  contact->is_near = true;
  return contact;
}

/// Within the `reach`, m.
std::optional<SweptContact> ContactPlaces::place_at_end(const SweptCandidate& candidate,
                                                        const SweptContact* acted,
                                                        double reach) const {
  const auto [first, second] = candidate.bodies;
  if (second == swept_ground || candidate.is_of_near_boxes) {
    const SweptContact contact =
        second == swept_ground ? place_on_ground(candidate, Moment::end) : move_to_end(candidate);
    return contact.distance < reach ? std::optional(contact) : std::nullopt;
  }
  const auto closest = closest_points(bodies_.surface(first), bodies_.surface(second),
                                      candidate.features, Moment::end, reach);
  if (!closest) return std::nullopt;
  if (!acted && (!stands(candidate, *closest, Moment::end) ||
                 are_beside_each_other(candidate, *closest, Moment::end)))
    return std::nullopt;
  SweptContact contact = place(candidate, *closest, Moment::end);
  if (!motion_.is_moved(contact)) return std::nullopt;
  if (acted && has_slid_off(candidate, *closest, contact)) {
    contact.is_near = false;
    contact.normal = acted->normal;
  }
  return contact;
}

/// From one face onto the next: another pair holds it now, and this one gives its impulse back
/// along the line on which it was given. Along the line to the edge between the faces it would
/// brake what slides. (Two soft bodies that both give way have no common point where that line
/// would not turn them.)
bool ContactPlaces::has_slid_off(const SweptCandidate& candidate, const ClosestPoints& closest,
                                 const SweptContact& contact) const {
  const auto gives_way_softly = [&](const SurfacePoint& side) {
    return !bodies_.is_rigid(side.body) && bodies_.side(world_, side).moves();
  };
  if (gives_way_softly(contact.first) && gives_way_softly(contact.second)) return false;
  return !contact.is_near || !stands(candidate, closest, Moment::end);
}

/// A contact at the start of the step that keeps two boxes apart where they would be in each other
/// at its end, along the normal that they have there.
SweptContact ContactPlaces::place_before_end(const SweptCandidate& candidate, const Vec3& normal,
                                             const BoxContactPoint& point) const {
  const auto [first, second] = candidate.bodies;
  SweptContact contact = place(candidate, candidate.start, Moment::start);
  contact.first.point = bodies_.point_before(world_, start_, first, point.point);
  contact.second.point = bodies_.point_before(world_, start_, second, point.point);
  meet_halfway(contact.first, contact.second);
  contact.normal = normal;
  contact.distance = -point.depth - normal.dot(motion_.displacement(contact));
  return contact;
}

/// The points of near boxes go with them, and their normal is that of the start.
SweptContact ContactPlaces::move_to_end(const SweptCandidate& candidate) const {
  SweptContact contact = place(candidate, candidate.start, Moment::start);
  const Vec3 of_first = bodies_.displacement(world_, start_, contact.first);
  const Vec3 of_second = bodies_.displacement(world_, start_, contact.second);
  contact.distance += contact.normal.dot(of_first - of_second);
  contact.is_near =
      contact.distance < motion_.near_distance(contact.first.body, contact.second.body);
  contact.first.point += of_first;
  contact.second.point += of_second;
  meet_halfway(contact.first, contact.second);
  return contact;
}

}  // namespace pneuma::sim

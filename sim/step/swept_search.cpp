#include "sim/step/swept_search.h"

#include <algorithm>
#include <limits>

#include "sim/soft/pins.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// Features that are nearer than the distance wanted by this factor are in contact.
constexpr double near_of_wanted = 1.5;
/// What features keep of their distance on their way: of that at the start, and of that wanted.
constexpr double kept_of_start = 0.1;
constexpr double kept_of_wanted = 0.05;
/// m. At less than this the direction between two points is rounding.
constexpr double min_distance = 1e-9;
/// Sine of the angle between faces that lie on each other: rounding; but a box with one contact for
/// each of its faces would rock on what is soft.
constexpr double flat = 1e-6, flat_of_boxes = 0.03;
constexpr double any_distance = std::numeric_limits<double>::infinity();

}  // namespace

/// What keeps its shape needs no skin that is thicker than the other's, however large its
/// triangles.
double SweptSearch::distance_wanted(int first, int second) const {
  if (second == swept_ground) return 0.0;
  const double one = bodies_.skin(first), other = bodies_.skin(second);
  return (is_kinematic(world_, first) ? std::min(one, other) : one) +
         (is_kinematic(world_, second) ? std::min(one, other) : other);
}

double SweptSearch::near_distance(int first, int second) const {
  if (second == swept_ground) return (near_of_wanted - 1.0) * bodies_.skin(first);
  return near_of_wanted * distance_wanted(first, second);
}

void SweptSearch::start() {
  m_.contacts.clear();
  m_.impulses.clear();
  for (SweptCandidate& candidate : m_.candidates) add_if_it_meets(candidate);
  has_started_ = true;
}

void SweptSearch::find_candidates() {
  has_started_ = false;
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

void SweptSearch::offer_near_features(const BodyPair& bodies) {
  bodies_.find_features(world_, start_, bodies, m_.found);
  for (const NearFeatures& features : m_.found) offer(bodies, features);
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

/// What parts so fast that gravity does not bring it back within the step is on its way.
bool SweptSearch::touches(const SweptCandidate& candidate) const {
  const SweptContact contact = candidate.bodies.second == swept_ground
                                   ? place_on_ground(candidate, Moment::start)
                                   : place(candidate, candidate.start, Moment::start);
  const double returns = 0.5 * time_step(world_.settings) * world_.settings.gravity.norm();
  return contact.is_near && contact.normal.dot(start_velocity(contact)) <= returns;
}

/// Boxes that touch each other alone fall together: none must fall by another way than the next.
void SweptSearch::find_borne_boxes() {
  base::DisjointSets& sets = m_.near_groups.sets;
  sets.reset();
  const int boxes = static_cast<int>(world_.rigid.size()), bearer = boxes;
  const auto number = [&](int body) {
    return bodies_.is_box(body) && !is_fixed(world_, body) ? bodies_.box(body) : bearer;
  };
  for (const SweptCandidate& candidate : m_.candidates) {
    const int first = number(candidate.bodies.first), second = number(candidate.bodies.second);
    if (sets.find(first) == sets.find(second) || !touches(candidate)) continue;
    sets.unite(first, second);
  }
  m_.is_borne.resize(world_.rigid.size());
  for (int i = 0; i < boxes; ++i) m_.is_borne[at(i)] = sets.find(i) == sets.find(bearer) ? 1 : 0;
}

/// Impulses keep from the ground what other impulses may move, and what would come so far below it
/// that it might not be put back onto it by itself.
void SweptSearch::find_near_ground() {
  mark_candidates();
  for (int i = 0; i < bodies_.count(); ++i) {
    if (bodies_.is_lone(i) || is_fixed(world_, i)) continue;
    const MovingSurface& surface = bodies_.surface(i);
    const double height = near_distance(i, swept_ground) + bodies_.allowance(i);
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

/// Only what may be in contact at the end of the step, wherever the allowances let it be. A way is
/// no longer than twice its allowance (SweptBodies), which says of most pairs that they are not.
void SweptSearch::offer(const BodyPair& bodies, const NearFeatures& features) {
  const auto [first, second] = bodies;
  const MovingSurface& a = bodies_.surface(first);
  const MovingSurface& b = bodies_.surface(second);
  const double touching = near_distance(first, second);
  const double allowed = bodies_.allowance(first) + bodies_.allowance(second);
  if (are_apart(a, b, features, touching + 3.0 * allowed)) return;
  const double reach = touching + allowed + greatest_change(a, b, features);
  const auto closest = closest_points(a, b, features, Moment::start, reach);
  if (closest) m_.candidates.push_back({bodies, features, *closest});
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
  bool collided = false;
  const auto all = std::span(m_.candidates);
  for (std::size_t first = 0, end = 0; first < all.size(); first = end) {
    const BodyPair bodies = all[first].bodies;
    while (end < all.size() && all[end].bodies == bodies) ++end;
    collided = find_collisions_of_pair(all.subspan(first, end - first)) || collided;
  }
  return collided;
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
/// the direction turns on the way. Without another contact the next round would do nothing.
void SweptSearch::hold_where_they_meet() {
  for (const auto& [candidate, fraction] : m_.meetings) {
    SweptCandidate& meeting = m_.candidates[at(candidate)];
    const SweptContact contact = meeting.contact < 0 ? place(meeting, meeting.start, Moment::start)
                                                     : place_along_line(meeting, fraction);
    if (is_moved(contact)) add(meeting, contact);
  }
}

/// The points that meet after a fraction of the step are kept apart along the line through them at
/// its start: along no other would the impulse keep angular momentum. A side that impulses do not
/// move takes up any: beside it they are kept apart in the direction in which they meet, or what
/// slides would be braked.
SweptContact SweptSearch::place_along_line(const SweptCandidate& candidate, double fraction) {
  SweptContact contact = place_at(candidate, fraction);
  const bool both_move =
      bodies_.side(world_, contact.first).moves() && bodies_.side(world_, contact.second).moves();
  if (!both_move) return contact;
  const Vec3 apart = contact.first.point - contact.second.point;
  contact.distance = apart.norm();
  if (contact.distance >= min_distance) contact.normal = apart / contact.distance;
  contact.wanted =
      std::min(distance_wanted(contact.first.body, contact.second.body), contact.distance);
  return contact;
}

/// Whether two features come too near each other on their ways. It becomes a contact: of boxes as
/// they meet, since they may turn until then; of others as they are at the start.
bool SweptSearch::meets(SweptCandidate& candidate) {
  const auto [first, second] = candidate.bodies;
  const double distance = candidate.start.distance;
  if (candidate.is_of_near_boxes) return sinks_in(candidate);
  // What touches at the start is held from there.
  if (distance < min_distance) return false;
  const double least =
      std::min(kept_of_start * distance, kept_of_wanted * distance_wanted(first, second));
  const auto fraction = time_of_meeting(bodies_.surface(first), bodies_.surface(second),
                                        candidate.features, distance, least);
  if (!fraction || !is_moved(place(candidate, candidate.start, Moment::start))) return false;
  blocked_ = candidate.bodies;
  m_.meetings.push_back({static_cast<int>(&candidate - m_.candidates.data()), *fraction});
  if (bodies_.is_rigid(first) && bodies_.is_rigid(second)) {
    add(candidate, place_at(candidate, *fraction));
  } else if (candidate.contact < 0 && stands(candidate, candidate.start, Moment::start)) {
    add(candidate, place(candidate, candidate.start, Moment::start));
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
    contact.is_missed = is_rigid(contact) &&
                        height < std::min(0.0, contact.distance) - bodies_.skin(contact.first.body);
    return contact.is_missed;
  }
  if (height >= -near_distance(candidate.bodies.first, swept_ground)) return false;
  blocked_ = candidate.bodies;
  return add_if_it_meets(candidate);
}

SweptContact SweptSearch::place_on_ground(const SweptCandidate& candidate, Moment moment) const {
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
          .is_near = point.z() < near_distance(body, swept_ground)};
}

SweptContact SweptSearch::place(const SweptCandidate& candidate, const ClosestPoints& closest,
                                Moment moment) const {
  const auto [first, second] = candidate.bodies;
  const auto& [of_first, of_second] = candidate.features;
  SweptContact contact = {
      .first = {first, of_first, closest.first_weights, closest.first_point},
      .second = {second, of_second, closest.second_weights, closest.second_point},
      .normal = normal_of(candidate, closest, moment),
      .distance = closest.distance,
      .wanted = distance_wanted(first, second),
      .is_near = closest.distance < near_distance(first, second)};
  contact.is_of_near_boxes = candidate.is_of_near_boxes;
  if (is_rigid(contact)) meet_halfway(contact.first, contact.second);
  return contact;
}

/// Between points that touch there is no direction: of boxes it is the one in which they are
/// furthest apart, of others that of the features.
Vec3 SweptSearch::normal_of(const SweptCandidate& candidate, const ClosestPoints& closest,
                            Moment moment) const {
  if (candidate.is_of_near_boxes) return candidate.normal;
  if (closest.distance >= min_distance) {
    return (closest.first_point - closest.second_point).normalized();
  }
  const MovingSurface& a = bodies_.surface(candidate.bodies.first);
  const MovingSurface& b = bodies_.surface(candidate.bodies.second);
  const bool are_boxes =
      bodies_.is_rigid(candidate.bodies.first) && bodies_.is_rigid(candidate.bodies.second);
  return are_boxes ? direction_apart(a, b, moment)
                   : touching_normal(a, b, candidate.features, moment);
}

bool SweptSearch::stands(const SweptCandidate& candidate, const ClosestPoints& closest,
                         Moment moment) const {
  if (candidate.is_of_near_boxes) return true;
  const auto [first, second] = candidate.bodies;
  const bool has_box = bodies_.is_rigid(first) || bodies_.is_rigid(second);
  return stands_for_its_parts(bodies_.surface(first), bodies_.surface(second), candidate.features,
                              closest, moment, has_box ? flat_of_boxes : flat);
}

/// At the start, as points that are nearest after a fraction of the step.
SweptContact SweptSearch::place_at(const SweptCandidate& candidate, double fraction) const {
  const MovingSurface& a = bodies_.surface(candidate.bodies.first);
  const MovingSurface& b = bodies_.surface(candidate.bodies.second);
  SweptContact contact =
      place(candidate, closest_points_at(a, b, candidate.features, fraction), Moment::start);
  contact.first.point = bodies_.start_point(contact.first);
  contact.second.point = bodies_.start_point(contact.second);
  contact.distance = contact.normal.dot(contact.first.point - contact.second.point);
  contact.wanted = std::min(contact.wanted, contact.distance);  // nothing is pushed along this line
  contact.is_near =
      candidate.start.distance < near_distance(contact.first.body, contact.second.body);
  return contact;
}

std::optional<SweptContact> SweptSearch::place_at_end(const SweptCandidate& candidate, bool acted) {
  const auto [first, second] = candidate.bodies;
  return place_at_end(candidate, acted, acted ? any_distance : near_distance(first, second));
}

std::optional<SweptContact> SweptSearch::place_beside_hit(const SweptCandidate& candidate) {
  const auto [first, second] = candidate.bodies;
  const double near = near_distance(first, second);
  auto contact = place_at_end(candidate, false, near + hit_together * bodies_.skin(first));
  if (!contact || contact->distance < near) return std::nullopt;
  contact->is_near = true;
  return contact;
}

/// Within the `reach`, m.
std::optional<SweptContact> SweptSearch::place_at_end(const SweptCandidate& candidate, bool acted,
                                                      double reach) {
  const auto [first, second] = candidate.bodies;
  if (second == swept_ground || candidate.is_of_near_boxes) {
    const SweptContact contact =
        second == swept_ground ? place_on_ground(candidate, Moment::end) : move_to_end(candidate);
    return contact.distance < reach ? std::optional(contact) : std::nullopt;
  }
  const auto closest = closest_points(bodies_.surface(first), bodies_.surface(second),
                                      candidate.features, Moment::end, reach);
  if (!closest || !(acted || stands(candidate, *closest, Moment::end))) return std::nullopt;
  const SweptContact contact = place(candidate, *closest, Moment::end);
  return is_moved(contact) ? std::optional(contact) : std::nullopt;
}

/// The points of a contact that is placed as boxes will meet lie apart until then.
std::pair<SurfacePoint, SurfacePoint> SweptSearch::where_impulses_act(
    const SweptContact& contact) const {
  std::pair<SurfacePoint, SurfacePoint> points(contact.first, contact.second);
  if (is_rigid(contact)) meet_halfway(points.first, points.second);
  return points;
}

SweptImpulse SweptSearch::impulse(const SweptContact& contact, double friction) {
  const auto [first, second] = where_impulses_act(contact);
  return {bodies_.side(world_, first), bodies_.side(world_, second), contact.normal, friction};
}

Vec3 SweptSearch::displacement(const SweptContact& contact) const {
  return bodies_.displacement(world_, start_, contact.first) -
         bodies_.displacement(world_, start_, contact.second);
}

Vec3 SweptSearch::shift(const SweptContact& contact) const {
  return bodies_.shift(contact.first) - bodies_.shift(contact.second);
}

Vec3 SweptSearch::start_velocity(const SweptContact& contact) const {
  const auto [first, second] = where_impulses_act(contact);
  return bodies_.start_velocity(world_, start_, first) -
         bodies_.start_velocity(world_, start_, second);
}

Vec3 SweptSearch::end_velocity(const SweptContact& contact) const {
  const auto [first, second] = where_impulses_act(contact);
  return bodies_.end_velocity(world_, first) - bodies_.end_velocity(world_, second);
}

bool SweptSearch::is_driven(const SurfacePoint& side) const {
  return side.body != swept_ground && is_kinematic(world_, side.body);
}

bool SweptSearch::is_driven(const SweptContact& contact) const {
  return is_driven(contact.first) || is_driven(contact.second);
}

Vec3 SweptSearch::driven_velocity(const SweptContact& contact, Moment moment) const {
  const auto of = [&](const SurfacePoint& side) -> Vec3 {
    if (!is_driven(side)) return Vec3::Zero();
    return moment == Moment::start ? bodies_.start_velocity(world_, start_, side)
                                   : bodies_.end_velocity(world_, side);
  };
  const auto [first, second] = where_impulses_act(contact);
  return of(second) - of(first);
}

const ContactMaterial& SweptSearch::material(int body) const {
  if (body == swept_ground) return *world_.settings.ground;
  return bodies_.is_rigid(body) ? world_.rigid[at(bodies_.box(body))].surface
                                : world_.soft[at(body)].material.surface;
}

ContactMaterial SweptSearch::material(const SweptContact& contact) const {
  return combine(material(contact.first.body), material(contact.second.body));
}

bool SweptSearch::is_rigid(const SweptContact& contact) const {
  const int second = contact.second.body;
  return bodies_.is_rigid(contact.first.body) &&
         (second == swept_ground || bodies_.is_rigid(second));
}

/// How the sides meet: with an even acceleration over the step, after the fraction of it in which
/// the distance is used up. `kicked`: by impulses since the start.
void SweptSearch::find_approach(SweptContact& contact, const Vec3& kicked) const {
  const Vec3 moved_by = displacement(contact) - shift(contact);
  const double mean = contact.normal.dot(moved_by) / time_step(world_.settings);
  const double before = contact.normal.dot(start_velocity(contact) + kicked);
  if (contact.is_near || mean >= 0.0) {
    contact.approach = std::max(0.0, -before);
    return;
  }
  SweptContact moved = contact;
  moved.first.point += bodies_.displacement(world_, start_, contact.first);
  moved.second.point += bodies_.displacement(world_, start_, contact.second);
  const double gained = contact.normal.dot(end_velocity(moved)) - before;
  const double left = contact.distance - contact.wanted;
  const double fraction = std::clamp(left / (-mean * time_step(world_.settings)), 0.0, 1.0);
  contact.approach = std::max(0.0, -(mean + (fraction - 0.5) * gained));
  contact.drift = mean - (before + 0.5 * gained);
}

bool SweptSearch::is_moved(const SweptContact& contact) {
  if (!bodies_.has_pins()) return true;
  return bodies_.side(world_, contact.first).moves() ||
         bodies_.side(world_, contact.second).moves();
}

bool SweptSearch::add_if_it_meets(SweptCandidate& candidate) {
  const auto [first, second] = candidate.bodies;
  const SweptContact contact = second == swept_ground
                                   ? place_on_ground(candidate, Moment::start)
                                   : place(candidate, candidate.start, Moment::start);
  if (contact.distance + contact.normal.dot(displacement(contact)) > near_distance(first, second))
    return false;
  if (second != swept_ground && !stands(candidate, candidate.start, Moment::start)) return false;
  if (!is_moved(contact)) return false;
  add(candidate, contact);
  return true;
}

void SweptSearch::add(SweptCandidate& candidate, SweptContact contact) {
  contact.previous = candidate.contact;
  candidate.contact = static_cast<int>(m_.contacts.size());
  // What is still on its way does not rub.
  m_.impulses.push_back(impulse(contact, contact.is_near ? material(contact).friction : 0.0));
  find_approach(contact, m_.impulses.back().change());
  m_.contacts.push_back(contact);
}

}  // namespace pneuma::sim

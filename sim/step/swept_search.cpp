#include "sim/step/swept_search.h"

#include <algorithm>

namespace pneuma::sim {
namespace {

/// Features that are nearer than the distance wanted by this factor are in contact.
constexpr double near = 1.5;
/// m. At less than this the direction between two points is rounding.
constexpr double min_distance = 1e-9;

}  // namespace

SweptIndex::Key SweptIndex::key(const SweptContact& contact) {
  const auto kind = [](const SurfacePoint& point) { return static_cast<int>(point.feature.kind); };
  return {contact.first.body,          contact.second.body,  kind(contact.first),
          contact.first.feature.index, kind(contact.second), contact.second.feature.index};
}

bool SweptIndex::insert(const SweptContact& contact, int number) {
  const std::pair entry(key(contact), number);
  const auto place =
      std::ranges::lower_bound(entries_, entry.first, {}, &std::pair<Key, int>::first);
  if (place != entries_.end() && place->first == entry.first) return false;
  entries_.insert(place, entry);
  return true;
}

int SweptIndex::find(const SweptContact& contact) const {
  const Key wanted = key(contact);
  const auto place = std::ranges::lower_bound(entries_, wanted, {}, &std::pair<Key, int>::first);
  return place != entries_.end() && place->first == wanted ? place->second : -1;
}

double SweptSearch::distance_wanted(int first, int second) const {
  return second == swept_ground ? 0.0 : bodies_.skin(first) + bodies_.skin(second);
}

/// How far beyond the distance wanted features still are in contact.
double SweptSearch::slack(int first, int second) const {
  const double wanted =
      second == swept_ground ? bodies_.skin(first) : distance_wanted(first, second);
  return (near - 1.0) * wanted;
}

void SweptSearch::start() {
  m_.contacts.clear();
  m_.impulses.clear();
  m_.index.clear();
  find_candidates();
  for (const SweptMemory::Candidate& candidate : m_.candidates) {
    const auto contact = place(candidate, Moment::start);
    if (contact) add_if_it_meets(*contact);
  }
}

void SweptSearch::find_candidates() {
  bodies_.set_end(world_);
  m_.candidates.clear();
  bodies_.find_near_bodies(m_.near_bodies);
  for (const BodyPair& pair : m_.near_bodies) {
    m_.found.clear();
    find_near_features(bodies_.surface(pair.first), bodies_.surface(pair.second), m_.found);
    for (const NearFeatures& features : m_.found) m_.candidates.push_back({pair, features});
  }
  if (world_.settings.ground) find_near_ground();
}

void SweptSearch::find_near_ground() {
  for (int i = 0; i < bodies_.count(); ++i) {
    const MovingSurface& surface = bodies_.surface(i);
    const double height = slack(i, swept_ground);
    for (int v = 0; v < surface.start.size(); ++v) {
      if (std::min(surface.start[v].z(), surface.end[v].z()) >= height) continue;
      m_.candidates.push_back({{i, swept_ground}, {{FeatureKind::vertex, v}, {}}});
    }
  }
}

bool SweptSearch::find_collisions() {
  bool collided = false;
  for (const SweptMemory::Candidate& candidate : m_.candidates) {
    const auto [first, second] = candidate.bodies;
    if (second == swept_ground) {
      collided = goes_into_ground(candidate) || collided;
      continue;
    }
    const MovingSurface& a = bodies_.surface(first);
    const MovingSurface& b = bodies_.surface(second);
    const double distance = closest_points(a, b, candidate.features, Moment::start).distance;
    if (distance < min_distance) continue;
    if (!collide_on_their_ways(a, b, candidate.features, distance)) continue;
    collided = true;
    blocked_ = candidate.bodies;
    const auto contact = place(candidate, Moment::start);
    if (contact) add(*contact, contact->normal.dot(displacement(*contact)));
  }
  return collided;
}

/// A vertex that other impulses pushed, and that was not yet held up.
bool SweptSearch::goes_into_ground(const SweptMemory::Candidate& candidate) {
  const SweptContact contact =
      place_on_ground(candidate.bodies.first, candidate.features.first, Moment::start);
  const double left = contact.distance + displacement(contact).z();
  return left < -slack(candidate.bodies.first, swept_ground) && add_if_it_meets(contact);
}

SweptContact SweptSearch::place_on_ground(int body, const Feature& vertex, Moment moment) const {
  const MovingSurface& surface = bodies_.surface(body);
  const Vec3 point =
      moment == Moment::start ? surface.start[vertex.index] : surface.end[vertex.index];
  return {.first = {body, vertex, {1.0, 0.0, 0.0}, point},
          .second = {swept_ground, {}, {}, point},
          .normal = Vec3::UnitZ(),
          .distance = point.z(),
          .wanted = 0.0,
          .is_near = point.z() < slack(body, swept_ground)};
}

std::optional<SweptContact> SweptSearch::place(const SweptMemory::Candidate& candidate,
                                               Moment moment) const {
  const auto [first, second] = candidate.bodies;
  const NearFeatures& features = candidate.features;
  if (second == swept_ground) return place_on_ground(first, features.first, moment);
  const MovingSurface& a = bodies_.surface(first);
  const MovingSurface& b = bodies_.surface(second);
  const ClosestPoints closest = closest_points(a, b, features, moment);
  if (closest.distance < min_distance) return std::nullopt;
  if (!stands_for_its_parts(a, b, features, closest, moment)) return std::nullopt;
  const double wanted = distance_wanted(first, second);
  return SweptContact{
      .first = {first, features.first, closest.first_weights, closest.first_point},
      .second = {second, features.second, closest.second_weights, closest.second_point},
      .normal = (closest.first_point - closest.second_point).normalized(),
      .distance = closest.distance,
      .wanted = wanted,
      .is_near = closest.distance < wanted + slack(first, second)};
}

SweptImpulse SweptSearch::impulse(const SweptContact& contact, double friction) {
  return {bodies_.side(world_, contact.first), bodies_.side(world_, contact.second), contact.normal,
          friction};
}

Vec3 SweptSearch::displacement(const SweptContact& contact) const {
  return bodies_.displacement(world_, start_, contact.first) -
         bodies_.displacement(world_, start_, contact.second);
}

Vec3 SweptSearch::start_velocity(const SweptContact& contact) const {
  return bodies_.start_velocity(start_, contact.first) -
         bodies_.start_velocity(start_, contact.second);
}

Vec3 SweptSearch::end_velocity(const SweptContact& contact) const {
  return bodies_.end_velocity(world_, contact.first) - bodies_.end_velocity(world_, contact.second);
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

std::pair<int, int> SweptSearch::boxes(const SweptContact& contact) const {
  const int second = contact.second.body;
  return {bodies_.box(contact.first.body), second == swept_ground ? -1 : bodies_.box(second)};
}

/// The speed at which the sides meet: with an even acceleration over the step, after the fraction
/// of it in which the distance is used up.
double SweptSearch::speed_of_meeting(const SweptContact& contact, double moved) const {
  const double before = contact.normal.dot(start_velocity(contact));
  if (contact.is_near || moved >= 0.0) return std::max(0.0, -before);
  const double after = 2.0 * moved / time_step(world_.settings) - before;
  const double fraction = std::clamp((contact.distance - contact.wanted) / -moved, 0.0, 1.0);
  return std::max(0.0, -(before + fraction * (after - before)));
}

bool SweptSearch::add_if_it_meets(const SweptContact& contact) {
  const double moved = contact.normal.dot(displacement(contact));
  const double left = contact.distance + moved;
  if (left > contact.wanted + slack(contact.first.body, contact.second.body)) return false;
  return add(contact, moved);
}

/// False if it is known already.
bool SweptSearch::add(SweptContact contact, double moved) {
  if (!m_.index.insert(contact, static_cast<int>(m_.contacts.size()))) return false;
  contact.approach = speed_of_meeting(contact, moved);
  m_.contacts.push_back(contact);
  // What is still on its way does not rub.
  m_.impulses.push_back(impulse(contact, contact.is_near ? material(contact).friction : 0.0));
  return true;
}

}  // namespace pneuma::sim

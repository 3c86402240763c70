#include "sim/step/swept/contact_motion.h"

#include <algorithm>

#include "sim/world/sleep.h"

namespace pneuma::sim {
/// What keeps its shape needs no skin that is thicker than the other's, however large it is: two
/// boxes keep twice the thinner one.
double ContactMotion::distance_wanted(int first, int second) const {
  if (second == swept_ground) return 0.0;
  const double one = bodies_.skin(first), other = bodies_.skin(second);
  const auto keeps_shape = [&](int body) {
    return bodies_.is_rigid(body) || is_kinematic(world_, body);
  };
  return (keeps_shape(first) ? std::min(one, other) : one) +
         (keeps_shape(second) ? std::min(one, other) : other);
}

double ContactMotion::near_distance(int first, int second) const {
  if (second == swept_ground) return (near_of_wanted - 1.0) * bodies_.skin(first);
  return near_distance(distance_wanted(first, second));
}

double ContactMotion::near_distance(double wanted) { return near_of_wanted * wanted; }

const ContactMaterial& ContactMotion::material(int body) const {
  if (body == swept_ground) return *world_.settings.ground;
  return bodies_.is_rigid(body) ? world_.rigid[at(bodies_.box(body))].surface
                                : world_.soft[at(body)].material.surface;
}

ContactMaterial ContactMotion::material(const SweptContact& contact) const {
  return combine(material(contact.first.body), material(contact.second.body));
}

bool ContactMotion::is_rigid(const SweptContact& contact) const {
  const int second = contact.second.body;
  return bodies_.is_rigid(contact.first.body) &&
         (second == swept_ground || bodies_.is_rigid(second));
}

bool ContactMotion::is_driven(const SurfacePoint& side) const {
  return side.body != swept_ground && is_kinematic(world_, side.body);
}

bool ContactMotion::is_driven(const SweptContact& contact) const {
  return is_driven(contact.first) || is_driven(contact.second);
}

bool ContactMotion::is_moved(const SweptContact& contact) const {
  if (!bodies_.has_pins()) return true;
  return bodies_.side(world_, contact.first).moves() ||
         bodies_.side(world_, contact.second).moves();
}

Vec3 ContactMotion::displacement(const SweptContact& contact) const {
  return bodies_.displacement(world_, start_, contact.first) -
         bodies_.displacement(world_, start_, contact.second);
}

Vec3 ContactMotion::shift(const SweptContact& contact) const {
  return bodies_.shift(contact.first) - bodies_.shift(contact.second);
}

/// At one point of both, so that they turn each other by the same. The points of a contact that is
/// placed as boxes will meet lie apart until then; a soft body's is on its surface. Beside an
/// obstacle, which no impulse turns, a box has its own.
std::pair<SurfacePoint, SurfacePoint> ContactMotion::where_impulses_act(
    const SweptContact& contact) const {
  std::pair<SurfacePoint, SurfacePoint> points(contact.first, contact.second);
  if (!is_rigid(contact) && bodies_.keep_shapes(pair_of(contact))) return points;
  if (is_rigid(contact)) {
    meet_halfway(points.first, points.second);
  } else if (bodies_.is_rigid(contact.first.body)) {
    points.first.point = points.second.point;
  } else if (contact.second.body != swept_ground && bodies_.is_rigid(contact.second.body)) {
    points.second.point = points.first.point;
  }
  return points;
}

SweptImpulse ContactMotion::impulse(const SweptContact& contact, double friction) const {
  const auto [first, second] = where_impulses_act(contact);
  return {bodies_.side(world_, first), bodies_.side(world_, second), contact.normal, friction};
}

Vec3 ContactMotion::start_velocity(const SweptContact& contact) const {
  const auto [first, second] = where_impulses_act(contact);
  return bodies_.start_velocity(world_, start_, first) -
         bodies_.start_velocity(world_, start_, second);
}

Vec3 ContactMotion::end_velocity(const SweptContact& contact) const {
  const auto [first, second] = where_impulses_act(contact);
  return bodies_.end_velocity(world_, first) - bodies_.end_velocity(world_, second);
}

Vec3 ContactMotion::driven_velocity(const SweptContact& contact, Moment moment) const {
  const auto of = [&](const SurfacePoint& side) -> Vec3 {
    if (!is_driven(side)) return Vec3::Zero();
    return moment == Moment::start ? bodies_.start_velocity(world_, start_, side)
                                   : bodies_.end_velocity(world_, side);
  };
  const auto [first, second] = where_impulses_act(contact);
  return of(second) - of(first);
}

/// With an even acceleration over the step, after the fraction of it in which the distance is used
/// up.
void ContactMotion::find_approach(SweptContact& contact, const Vec3& kicked) const {
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

}  // namespace pneuma::sim

#include "sim/response/impulse.h"

#include <algorithm>
#include <cmath>

#include "sim/response/contact_side.h"

namespace pneuma::sim {
namespace {

/// 1/m0 + 1/m1 + rotational terms: the denominator of j.
double inverse_mass(const World& world, const Contact& contact, const Vec3& direction) {
  return inverse_mass_along(world, contact.first, contact.point, direction) +
         inverse_mass_along(world, contact.second, contact.point, direction);
}

void apply(World& world, const Contact& contact, const Vec3& impulse) {
  apply_impulse(world, contact.first, contact.point, impulse);
  apply_impulse(world, contact.second, contact.point, -impulse);
}

}  // namespace

Surface combine(const Surface& a, const Surface& b) {
  return {std::max(a.restitution, b.restitution), std::sqrt(a.friction * b.friction)};
}

Vec3 relative_velocity(const World& world, const Contact& contact) {
  return velocity_at(world, contact.first, contact.point) -
         velocity_at(world, contact.second, contact.point);
}

Impulse apply_contact_impulse(World& world, const Contact& contact, double start_approach) {
  const Surface pair = combine(surface(world, contact.first), surface(world, contact.second));
  const double approach = -relative_velocity(world, contact).dot(contact.normal);
  if (!(approach > 0.0)) return {};

  // j = -(1 + epsilon) v_rel . n / (1/m0 + 1/m1 + ...), the bounce taken from the start of the
  // step.
  const double bounce = pair.restitution * std::clamp(start_approach, 0.0, approach);
  const double j = (approach + bounce) / inverse_mass(world, contact, contact.normal);
  apply(world, contact, j * contact.normal);

  // Friction opposes the sliding, with at most mu j, and stops it at most (ERRATA row 6).
  const Vec3 velocity = relative_velocity(world, contact);
  const Vec3 sliding = velocity - velocity.dot(contact.normal) * contact.normal;
  const double speed = sliding.norm();
  if (!(speed > 0.0)) return {j, 0.0, pair.friction > 0.0};
  const Vec3 direction = sliding / speed;
  const double stop = speed / inverse_mass(world, contact, direction);
  const double friction = std::min(pair.friction * j, stop);
  apply(world, contact, -friction * direction);
  return {j, friction, friction == stop};
}

}  // namespace pneuma::sim

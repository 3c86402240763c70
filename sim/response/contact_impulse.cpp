#include "sim/response/contact_impulse.h"

#include <algorithm>

namespace pneuma::sim {

ContactImpulse::ContactImpulse(World& world, std::span<const BoxMass> masses,
                               const Contact& contact, double start_approach)
    : first_(world, masses, contact.first, contact.point),
      second_(world, masses, contact.second, contact.point),
      normal_(contact.normal),
      depth_(contact.depth),
      start_gap_(first_.place() - second_.place()) {
  const auto mass_along = [this](const Vec3& direction) {
    return 1.0 / (first_.inverse_mass_along(direction) + second_.inverse_mass_along(direction));
  };
  tangents_[0] = normal_.unitOrthogonal();
  tangents_[1] = normal_.cross(tangents_[0]);
  normal_mass_ = mass_along(normal_);
  tangent_masses_ = {mass_along(tangents_[0]), mass_along(tangents_[1])};

  const Surface pair = combine(surface(world, contact.first), surface(world, contact.second));
  friction_ = pair.friction;
  const double approach = std::max(0.0, -relative_velocity().dot(normal_));
  const double closing =
      contact.gap / time_step(world.settings);  // m/s that close the gap in a step
  target_ = start_approach > closing || contact.gap == 0.0
                ? pair.restitution * std::clamp(start_approach, 0.0, approach)
                : -closing;
}

void ContactImpulse::apply(const Vec3& impulse) const {
  first_.apply(impulse);
  second_.apply(-impulse);
}

void ContactImpulse::start_from(const Vec3& impulse) {
  const double along = impulse.dot(normal_);
  const double normal = std::max(0.0, along);
  const Vec3 friction = impulse - along * normal_;
  impulse_.normal += normal;
  impulse_.friction += friction;
  apply(normal * normal_ + friction);
}

double ContactImpulse::correct() {
  const double normal_change = correct_normal();
  return normal_change + (friction_ > 0.0 ? correct_friction() : 0.0);
}

double ContactImpulse::correct_normal() {
  const double parting = relative_velocity().dot(normal_);
  const double before = impulse_.normal;
  impulse_.normal = std::max(0.0, before + normal_mass_ * (target_ - parting));
  const double change = impulse_.normal - before;
  if (change != 0.0) apply(change * normal_);
  return std::abs(change);
}

double ContactImpulse::correct_friction() {
  const double limit = friction_ * impulse_.normal;
  const Vec3 before = impulse_.friction;
  sticks_ = false;
  if (limit == 0.0 && before.isZero(0.0)) return 0.0;  // sides that do not press are left alone
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 change = -tangent_masses_[i] * relative_velocity().dot(tangents_[i]) * tangents_[i];
    impulse_.friction += change;
    apply(change);
  }
  // Coulomb's limit on what would stop the sliding altogether.
  const Vec3 stopping = impulse_.friction;
  const double size = stopping.norm();
  sticks_ = size <= limit;
  if (!sticks_) {
    impulse_.friction *= limit / size;
    apply(impulse_.friction - stopping);
  }
  return (impulse_.friction - before).norm();
}

void ContactImpulse::separate(double share) const {
  const double moved = (first_.place() - second_.place() - start_gap_).dot(normal_);
  const double left = share * depth_ - moved;
  if (!(left > 0.0)) return;
  const double of_first = first_.inverse_mass() / (first_.inverse_mass() + second_.inverse_mass());
  first_.displace(of_first * left * normal_);
  second_.displace((of_first - 1.0) * left * normal_);
}

}  // namespace pneuma::sim

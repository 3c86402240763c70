#include "sim/response/contact_impulse.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {
ContactImpulse::ContactImpulse(World& world, std::span<const BoxMass> masses,
                               const Contact& contact, double start_approach, double& work)
    : first_(world, masses, contact.first, contact.point),
      second_(world, masses, contact.second, contact.point),
      normal_(contact.normal),
      depth_(contact.depth),
      start_gap_(first_.place() - second_.place()),
      work_(&work) {
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
  if (start_approach <= closing && contact.gap > 0.0) {
    target_ = -closing;
  } else {
    bounce_speed_ = pair.restitution * std::clamp(start_approach, 0.0, approach);
    if (bounce_speed_ < least_bounce_speed) bounce_speed_ = 0.0;
  }
}

void ContactImpulse::apply(const Vec3& impulse) const {
  first_.apply(impulse);
  second_.apply(-impulse);
}

void ContactImpulse::start_from(const Vec3& impulse) {
  const double along = impulse.dot(normal_);
  const double normal = std::max(0.0, along);
  // The normal may have turned since, so that the old impulse has more across it than friction may.
  Vec3 friction = impulse - along * normal_;
  const double limit = friction_ * normal;
  const double size = friction.norm();
  if (size > limit) friction *= limit / size;
  const Vec3 before = relative_velocity();
  impulse_.normal += normal;
  impulse_.friction += friction;
  apply(normal * normal_ + friction);
  *work_ += 0.5 * (normal * normal_ + friction).dot(before + relative_velocity());
}

double ContactImpulse::correct() {
  const double normal_change = correct_normal();
  return normal_change + (friction_ > 0.0 ? correct_friction() : 0.0);
}

double ContactImpulse::correct_normal() {
  const double parting = relative_velocity().dot(normal_);
  const double before = impulse_.normal;
  double change = normal_mass_ * (target_ - parting);
  if (target_ > 0.0) change = std::min(change, most_without_gain(parting));
  impulse_.normal = std::max(0.0, before + change);
  change = impulse_.normal - before;
  if (change == 0.0) return 0.0;
  apply(change * normal_);
  *work_ += change * (parting + 0.5 * change / normal_mass_);
  return std::abs(change);
}

/// The work of an impulse j on sides that part with v is j (v + j / 2m): at most what has been
/// taken from them.
double ContactImpulse::most_without_gain(double parting) const {
  const double taken = std::max(0.0, -*work_);
  return normal_mass_ * (std::sqrt(parting * parting + 2.0 * taken / normal_mass_) - parting);
}

bool ContactImpulse::bounce() {
  target_ = std::max(target_, bounce_speed_);
  return bounce_speed_ > 0.0 && impulse_.normal > 0.0;
}

double ContactImpulse::correct_friction() {
  const double limit = friction_ * impulse_.normal;
  const Vec3 before = impulse_.friction;
  sticks_ = false;
  if (limit == 0.0 && before.isZero(0.0)) return 0.0;  // sides that do not press are left alone
  const Vec3 velocity_before = relative_velocity();
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
  const Vec3 change = impulse_.friction - before;
  const double gain = 0.5 * change.dot(velocity_before + relative_velocity());
  // Turning bodies answer to a force in one direction by a motion in another, so that friction cut
  // back to its limit may drive them a little. When they bounce, with no energy to spare, it is
  // then left as it was.
  if (target_ > 0.0 && gain > 0.0 && before.norm() <= limit) {
    apply(-change);
    impulse_.friction = before;
    return 0.0;
  }
  *work_ += gain;
  return change.norm();
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

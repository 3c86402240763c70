#include "sim/response/contact_impulse.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {
namespace {

Mat3 contact_axes(const Vec3& normal) {
  Mat3 axes;
  axes.col(0) = normal;
  axes.col(1) = normal.unitOrthogonal();
  axes.col(2) = normal.cross(axes.col(1));
  return axes;
}

}  // namespace

ContactImpulse::ContactImpulse(World& world, std::span<const BoxMass> masses,
                               const Contact& contact, double start_approach, double& work)
    : first_(world, masses, contact.first, contact.point),
      second_(world, masses, contact.second, contact.point),
      axes_(contact_axes(contact.normal)),
      mobility_(axes_.transpose() * (first_.mobility() + second_.mobility()) * axes_),
      depth_(contact.depth),
      start_gap_((first_.place() - second_.place()).dot(normal())),
      work_(&work) {
  const Surface pair = combine(surface(world, contact.first), surface(world, contact.second));
  friction_ = pair.friction;
  const double approach = std::max(0.0, -relative_velocity().x());
  const double closing =
      contact.gap / time_step(world.settings);  // m/s that close the gap in a step
  if (start_approach <= closing && contact.gap > 0.0) {
    target_ = -closing;
  } else {
    bounce_speed_ = pair.restitution * std::clamp(start_approach, 0.0, approach);
    if (bounce_speed_ < least_bounce_speed) bounce_speed_ = 0.0;
  }
}

Vec3 ContactImpulse::relative_velocity() const {
  return axes_.transpose() * (first_.velocity() - second_.velocity());
}

void ContactImpulse::apply(const Vec3& impulse) const {
  const Vec3 in_world = axes_ * impulse;
  first_.apply(in_world);
  second_.apply(-in_world);
}

void ContactImpulse::start_from(const Vec3& impulse) {
  Vec3 start = axes_.transpose() * impulse;
  start.x() = std::max(0.0, start.x());
  // The normal may have turned since, so that the old impulse has more across it than friction may.
  const double limit = friction_ * start.x();
  const double size = start.tail<2>().norm();
  if (size > limit) start.tail<2>() *= limit / size;
  const Vec3 before = relative_velocity();
  impulse_.normal += start.x();
  impulse_.friction += start.tail<2>();
  apply(start);
  *work_ += start.dot(before + 0.5 * mobility_ * start);
}

double ContactImpulse::correct() {
  Vec3 velocity = relative_velocity();
  Vec3 change = Vec3::Zero();
  correct_normal(velocity, change);
  if (friction_ > 0.0) correct_friction(velocity, change);
  if (change.isZero(0.0)) return 0.0;
  apply(change);
  return std::abs(change.x()) + change.tail<2>().norm();
}

void ContactImpulse::correct_normal(Vec3& velocity, Vec3& change) {
  const double parting = velocity.x();
  const double before = impulse_.normal;
  double wanted = (target_ - parting) / mobility_(0, 0);
  if (target_ > 0.0) wanted = std::min(wanted, most_without_gain(parting));
  impulse_.normal = std::max(0.0, before + wanted);
  change.x() = impulse_.normal - before;
  velocity += change.x() * mobility_.col(0);
  *work_ += change.x() * (parting + 0.5 * change.x() * mobility_(0, 0));
}

/// The work of an impulse j on sides that part with v is j (v + j / 2m): at most what has been
/// taken from them.
double ContactImpulse::most_without_gain(double parting) const {
  const double taken = std::max(0.0, -*work_);
  const double mobility = mobility_(0, 0);
  return (std::sqrt(parting * parting + 2.0 * taken * mobility) - parting) / mobility;
}

bool ContactImpulse::bounce() {
  target_ = std::max(target_, bounce_speed_);
  return bounce_speed_ > 0.0 && impulse_.normal > 0.0;
}

void ContactImpulse::correct_friction(Vec3& velocity, Vec3& change) {
  const double limit = friction_ * impulse_.normal;
  const Eigen::Vector2d before = impulse_.friction;
  sticks_ = false;
  if (limit == 0.0 && before.isZero(0.0)) return;  // sides that do not press are left alone
  // What stops the sliding along one tangent, then along the other.
  Eigen::Vector2d stopping = before;
  Vec3 stopped = velocity;
  for (int i = 0; i < 2; ++i) {
    const double along = -stopped[1 + i] / mobility_(1 + i, 1 + i);
    stopping[i] += along;
    stopped += along * mobility_.col(1 + i);
  }
  // Coulomb's limit on what would stop the sliding altogether.
  const double size = stopping.norm();
  sticks_ = size <= limit;
  if (!sticks_) stopping *= limit / size;
  const Eigen::Vector2d difference = stopping - before;
  const Vec3 after = velocity + mobility_.rightCols<2>() * difference;
  const double gain = 0.5 * difference.dot((velocity + after).tail<2>());
  // Turning bodies answer to a force in one direction by a motion in another, so that friction cut
  // back to its limit may drive them a little. When they bounce, with no energy to spare, it is
  // then left as it was.
  if (target_ > 0.0 && gain > 0.0 && before.norm() <= limit) return;
  impulse_.friction = stopping;
  change.tail<2>() = difference;
  velocity = after;
  *work_ += gain;
}

void ContactImpulse::separate(double share) const {
  const double moved = (first_.place() - second_.place()).dot(normal()) - start_gap_;
  const double left = share * depth_ - moved;
  if (!(left > 0.0)) return;
  const double of_first = first_.inverse_mass() / (first_.inverse_mass() + second_.inverse_mass());
  first_.displace(of_first * left * normal());
  second_.displace((of_first - 1.0) * left * normal());
}

}  // namespace pneuma::sim

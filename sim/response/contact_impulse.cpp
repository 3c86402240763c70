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
      normal_mass_(1.0 / mobility_(0, 0)),
      tangent_masses_{1.0 / mobility_(1, 1), 1.0 / mobility_(2, 2)},
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
  change.x() = correct_normal(velocity);
  if (friction_ > 0.0) correct_friction(velocity, change);
  const double size = change.lpNorm<1>();
  if (size > 0.0) apply(change);
  return size;
}

double ContactImpulse::correct_normal(Vec3& velocity) {
  const double parting = velocity.x();
  const double before = impulse_.normal;
  double wanted = (target_ - parting) * normal_mass_;
  if (target_ > 0.0) wanted = std::min(wanted, most_without_gain(parting));
  impulse_.normal = std::max(0.0, before + wanted);
  const double change = impulse_.normal - before;
  velocity += change * mobility_.col(0);
  *work_ += change * (parting + 0.5 * change * mobility_(0, 0));
  return change;
}

/// The work of an impulse j on sides that part with v is j (v + j / 2m): at most what has been
/// taken from them.
double ContactImpulse::most_without_gain(double parting) const {
  const double taken = std::max(0.0, -*work_);
  return normal_mass_ * (std::sqrt(parting * parting + 2.0 * taken * mobility_(0, 0)) - parting);
}

bool ContactImpulse::bounce() {
  target_ = std::max(target_, bounce_speed_);
  return bounce_speed_ > 0.0 && impulse_.normal > 0.0;
}

// In scalars: the time goes into a chain of operations each of which waits for the last.
void ContactImpulse::correct_friction(const Vec3& velocity, Vec3& change) {
  const double limit = friction_ * impulse_.normal;
  const double before_1 = impulse_.friction.x(), before_2 = impulse_.friction.y();
  const double before_squared = before_1 * before_1 + before_2 * before_2;
  sticks_ = false;
  if (limit == 0.0 && before_squared == 0.0) return;  // sides that do not press are left alone
  // What stops the sliding along one tangent, then along the other.
  const double along_1 = -velocity.y() * tangent_masses_[0];
  const double along_2 = -(velocity.z() + along_1 * mobility_(2, 1)) * tangent_masses_[1];
  double after_1 = before_1 + along_1, after_2 = before_2 + along_2;
  // Coulomb's limit on what would stop the sliding altogether.
  const double squared = after_1 * after_1 + after_2 * after_2;
  sticks_ = squared <= limit * limit;
  if (!sticks_) {
    const double share = limit / std::sqrt(squared);
    after_1 *= share;
    after_2 *= share;
  }
  const double change_1 = after_1 - before_1, change_2 = after_2 - before_2;
  // From the speeds before and after: 2 v + K j.
  const double gain = 0.5 * (change_1 * (2.0 * velocity.y() + mobility_(1, 1) * change_1) +
                             change_2 * (2.0 * velocity.z() + mobility_(2, 2) * change_2)) +
                      mobility_(2, 1) * change_1 * change_2;
  // Turning bodies answer to a force in one direction by a motion in another, so that friction cut
  // back to its limit may drive them a little. When they bounce, with no energy to spare, it is
  // then left as it was.
  if (target_ > 0.0 && gain > 0.0 && before_squared <= limit * limit) return;
  impulse_.friction = {after_1, after_2};
  change.y() = change_1;
  change.z() = change_2;
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

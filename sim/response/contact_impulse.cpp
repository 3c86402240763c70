#include "sim/response/contact_impulse.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {
namespace {

/// The normal, and two tangents without a root or a branch: Duff et al., Building an Orthonormal
/// Basis, Revisited, JCGT 6 (2017), written as what takes +-z to the normal does to x and y.
RowMatrix contact_axes(const Vec3& n) {
  const double sign = std::copysign(1.0, n.z());
  const double a = -1.0 / (sign + n.z());
  const Row normal = to_row(n);
  const Row halfway = normal + Row{0.0, 0.0, sign, 0.0};
  return {{normal, Row{1.0, 0.0, 0.0, 0.0} + (sign * n.x() * a) * halfway,
           Row{0.0, sign, 0.0, 0.0} + (n.y() * a) * halfway}};
}

RowMatrix sum(const RowMatrix& a, const RowMatrix& b) {
  return {{a.columns[0] + b.columns[0], a.columns[1] + b.columns[1], a.columns[2] + b.columns[2]}};
}

TangentMass tangent_mass(const RowMatrix& mobility) {
  const double a = mobility.columns[1][1], b = mobility.columns[1][2], c = mobility.columns[2][2];
  const double determinant = a * c - b * b;
  const double half_difference = 0.5 * (a - c);
  const double greatest = 0.5 * (a + c) + std::sqrt(half_difference * half_difference + b * b);
  return {c / determinant, -b / determinant, a / determinant, 1.0 / greatest};
}

}  // namespace

Row ContactImpulse::relative_velocity() const {
  return to_axes_ * (first_.velocity() - second_.velocity()) +
         (first_.turning_velocity() - second_.turning_velocity());
}

void ContactImpulse::apply(Row impulse) const {
  const Row in_world = axes_ * impulse;
  first_.apply(in_world, impulse);
  second_.apply(-in_world, -impulse);
}

ContactImpulse::ContactImpulse(World& world, std::span<const BoxMass> masses,
                               const Contact& contact, double start_approach, double& work)
    : axes_(contact_axes(contact.normal)),
      to_axes_(transposed(axes_)),
      first_(world, masses, contact.first, contact.point, axes_),
      second_(world, masses, contact.second, contact.point, axes_),
      mobility_(sum(first_.mobility(), second_.mobility())),
      normal_mass_(1.0 / mobility_.columns[0][0]),
      tangent_mass_(tangent_mass(mobility_)),
      depth_(contact.depth),
      start_gap_(dot(first_.place() - second_.place(), axes_.columns[0])),
      work_(&work) {
  const Surface pair = combine(surface(world, contact.first), surface(world, contact.second));
  friction_ = pair.friction;
  const double approach = std::max(0.0, -relative_velocity()[0]);
  const double closing =
      contact.gap / time_step(world.settings);  // m/s that close the gap in a step
  if (start_approach <= closing && contact.gap > 0.0) {
    target_ = -closing;
  } else {
    bounce_speed_ = pair.restitution * std::clamp(start_approach, 0.0, approach);
    if (bounce_speed_ < least_bounce_speed) bounce_speed_ = 0.0;
  }
}

void ContactImpulse::start_from(const Vec3& impulse) {
  Vec3 start = to_vec3(to_axes_ * to_row(impulse));
  start.x() = std::max(0.0, start.x());
  // The normal may have turned since, so that the old impulse has more across it than friction may.
  const double limit = friction_ * start.x();
  const double size = start.tail<2>().norm();
  if (size > limit) start.tail<2>() *= limit / size;
  const Row given = to_row(start);
  const Row before = relative_velocity();
  impulse_.normal += start.x();
  impulse_.friction += start.tail<2>();
  apply(given);
  *work_ += dot(given, before + 0.5 * (mobility_ * given));
}

/// The work of an impulse j on sides that part with v is j (v + j / 2m): at most what has been
/// taken from them.
double ContactImpulse::most_without_gain(double parting) const {
  const double taken = std::max(0.0, -*work_);
  return normal_mass_ *
         (std::sqrt(parting * parting + 2.0 * taken * mobility_.columns[0][0]) - parting);
}

double ContactImpulse::correct_normal(double parting) {
  const double before = impulse_.normal;
  double wanted = (target_ - parting) * normal_mass_;
  if (target_ > 0.0) wanted = std::min(wanted, most_without_gain(parting));
  impulse_.normal = std::max(0.0, before + wanted);
  const double change = impulse_.normal - before;
  *work_ += change * (parting + 0.5 * change * mobility_.columns[0][0]);
  return change;
}

bool ContactImpulse::bounce() {
  if (bounce_speed_ > 0.0) target_ = bounce_speed_;
  return bounce_speed_ > 0.0 && impulse_.normal > 0.0;
}

// What stops the sliding, if Coulomb's limit allows it. Else the nearest point within the limit to
// a step j - m v against the sliding, m the least of the masses that friction meets: wherever that
// comes to rest, friction is at its limit and opposes the sliding, whatever the tangents are. From
// a point within the limit neither adds energy: the nearest point to j - m v, which is j + d, has
// d (d + m v) <= 0, so that the work d v + d K d / 2 is at most -d d / 2m.
// In scalars: the time goes into a chain of operations each of which waits for the last.
Row ContactImpulse::correct_friction(Row velocity) {
  const double limit = friction_ * impulse_.normal;
  const double before_1 = impulse_.friction.x(), before_2 = impulse_.friction.y();
  sticks_ = false;
  // Sides that do not press are left alone.
  if (limit == 0.0 && before_1 == 0.0 && before_2 == 0.0) return Row{};
  const double v_1 = velocity[1], v_2 = velocity[2];
  const TangentMass& mass = tangent_mass_;
  double after_1 = before_1 - (mass.first * v_1 + mass.across * v_2);
  double after_2 = before_2 - (mass.across * v_1 + mass.second * v_2);
  sticks_ = after_1 * after_1 + after_2 * after_2 <= limit * limit;
  if (!sticks_) {
    after_1 = before_1 - mass.least * v_1;
    after_2 = before_2 - mass.least * v_2;
    const double squared = after_1 * after_1 + after_2 * after_2;
    if (squared > limit * limit) {
      const double share = limit / std::sqrt(squared);
      after_1 *= share;
      after_2 *= share;
    }
  }
  impulse_.friction = {after_1, after_2};
  const Row change{0.0, after_1 - before_1, after_2 - before_2, 0.0};
  *work_ += dot(change, velocity + 0.5 * (mobility_ * change));
  return change;
}

double ContactImpulse::correct() {
  Row velocity = relative_velocity();
  const double normal = correct_normal(velocity[0]);
  velocity += normal * mobility_.columns[0];
  Row change{normal, 0.0, 0.0, 0.0};
  if (friction_ > 0.0) change += correct_friction(velocity);
  const double size = std::abs(change[0]) + std::abs(change[1]) + std::abs(change[2]);
  if (size > 0.0) apply(change);
  return size;
}

bool ContactImpulse::separate(double share) const {
  const Row normal = axes_.columns[0];
  const double moved = dot(first_.place() - second_.place(), normal) - start_gap_;
  const double left = share * depth_ - moved;
  if (!(left > 0.0)) return false;
  const double of_first = first_.inverse_mass() / (first_.inverse_mass() + second_.inverse_mass());
  first_.displace(of_first * left * normal);
  second_.displace((of_first - 1.0) * left * normal);
  return true;
}

}  // namespace pneuma::sim

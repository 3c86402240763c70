#include "sim/response/contact_impulse.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pneuma::sim {
namespace {

/// Across a unit normal, at right angles to each other, without a root or a branch: Duff et al.,
/// Building an Orthonormal Basis, Revisited, JCGT 6 (2017), written as what takes +-z to the normal
/// does to x and y.
std::array<Vec4d, 2> tangents(Vec4d normal) {
  const double sign = std::copysign(1.0, normal[2]);
  const double a = -1.0 / (sign + normal[2]);
  const Vec4d halfway = normal + Vec4d{0.0, 0.0, sign, 0.0};
  return {Vec4d{1.0, 0.0, 0.0, 0.0} + (sign * normal[0] * a) * halfway,
          Vec4d{0.0, sign, 0.0, 0.0} + (normal[1] * a) * halfway};
}

Mat3x4 sum(const Mat3x4& a, const Mat3x4& b) {
  return {{a.columns[0] + b.columns[0], a.columns[1] + b.columns[1], a.columns[2] + b.columns[2]}};
}

/// Where turning adds nothing, the mass is the same in all directions.
TangentMass tangent_mass_of_points(double mass, Vec4d normal) {
  return {{{mass * (Vec4d{1.0, 0.0, 0.0, 0.0} - normal[0] * normal),
            mass * (Vec4d{0.0, 1.0, 0.0, 0.0} - normal[1] * normal),
            mass * (Vec4d{0.0, 0.0, 1.0, 0.0} - normal[2] * normal)}},
          mass};
}

/// With two tangents s and t, and the inverse p q r of the mobility (a b, b c) along them: p s s' +
/// q (s t' + t s') + r t t'.
TangentMass tangent_mass(const Mat3x4& mobility, Vec4d normal) {
  const auto& [s, t] = tangents(normal);
  const Vec4d along_s = mobility * s, along_t = mobility * t;
  const double a = dot(s, along_s), b = dot(t, along_s), c = dot(t, along_t);
  const double inverse_determinant = 1.0 / (a * c - b * b);
  const double half_difference = 0.5 * (a - c);
  const double max_mobility = 0.5 * (a + c) + std::sqrt(half_difference * half_difference + b * b);
  const Vec4d with_s = inverse_determinant * (c * s - b * t);
  const Vec4d with_t = inverse_determinant * (a * t - b * s);
  return {{{with_s * s[0] + with_t * t[0], with_s * s[1] + with_t * t[1],
            with_s * s[2] + with_t * t[2]}},
          1.0 / max_mobility};
}

}  // namespace

void ContactImpulse::apply(Vec4d impulse) const {
  first_.apply(impulse);
  second_.apply(-impulse);
}

ContactImpulse::ContactImpulse(World& world, std::span<const BoxMass> masses,
                               const Contact& contact, double start_approach, double& work)
    : normal_(to_vec4d(contact.normal)),
      first_(world, masses, contact.first, contact.point),
      second_(world, masses, contact.second, contact.point),
      mobility_(sum(first_.mobility(), second_.mobility())),
      normal_response_(mobility_ * normal_),
      normal_mobility_(dot(normal_response_, normal_)),
      normal_mass_(1.0 / normal_mobility_),
      depth_(contact.depth),
      start_distance_(dot(first_.position() - second_.position(), normal_)),
      work_(&work) {
  const ContactMaterial pair =
      combine(surface(world, contact.first), surface(world, contact.second));
  friction_ = pair.friction;
  if (friction_ > 0.0) {
    const bool turns = first_.turns() || second_.turns();
    tangent_mass_ =
        turns ? tangent_mass(mobility_, normal_) : tangent_mass_of_points(normal_mass_, normal_);
    if (turns) friction_response_ = tangent_mass_.matrix * normal_response_;
  }
  const double approach = std::max(0.0, -dot(relative_velocity(), normal_));
  // m/s that use the margin up in a step.
  const double margin_speed = contact.speculative_margin / time_step(world.settings);
  if (start_approach <= margin_speed && contact.speculative_margin > 0.0) {
    target_ = -margin_speed;
  } else {
    bounce_speed_ = pair.restitution * std::clamp(start_approach, 0.0, approach);
    if (bounce_speed_ < min_bounce_speed) bounce_speed_ = 0.0;
  }
}

void ContactImpulse::warm_start(const Vec3& impulse) {
  const Vec4d start = to_vec4d(impulse);
  const double along = dot(start, normal_);
  const double pressing = std::max(0.0, along);
  Vec4d across = start - along * normal_;
  // The normal may have turned since, so that the old impulse has more across it than friction may.
  const double limit = friction_ * pressing;
  const double size = std::sqrt(dot(across, across));
  if (size > limit) across *= limit / size;
  const Vec4d given = pressing * normal_ + across;
  const Vec4d before = relative_velocity();
  normal_impulse_ += pressing;
  friction_impulse_ += across;
  apply(given);
  *work_ += dot(given, before + 0.5 * (mobility_ * given));
}

/// The work of an impulse j on sides that part with v is j (v + j / 2m): at most what has been
/// taken from them.
double ContactImpulse::max_without_gain(double parting) const {
  const double taken = std::max(0.0, -*work_);
  return normal_mass_ * (std::sqrt(parting * parting + 2.0 * taken * normal_mobility_) - parting);
}

double ContactImpulse::correct_normal(double parting) {
  const double before = normal_impulse_;
  double wanted = (target_ - parting) * normal_mass_;
  if (target_ > 0.0) wanted = std::min(wanted, max_without_gain(parting));
  normal_impulse_ = std::max(0.0, before + wanted);
  const double change = normal_impulse_ - before;
  *work_ += change * (parting + 0.5 * change * normal_mobility_);
  return change;
}

bool ContactImpulse::bounce() {
  if (bounce_speed_ > 0.0) target_ = bounce_speed_;
  return bounce_speed_ > 0.0 && normal_impulse_ > 0.0;
}

// What stops the sliding, if Coulomb's limit allows it. Else the nearest point within the limit to
// a step j - m v against the sliding, m the smallest of the masses that friction meets: wherever
// that comes to rest, friction is at its limit and opposes the sliding, whatever the tangents are.
// From a point within the limit neither adds energy: the nearest point to j - m v, which is j + d,
// has d (d + m v) <= 0, so that the work d v + d K d / 2 is at most -d d / 2m. friction_response_
// holds what of it comes from the normal's correction: the time goes into a chain of operations
// each of which waits for the last.
Vec4d ContactImpulse::correct_friction(Vec4d velocity, double normal) {
  const double limit = friction_ * normal_impulse_;
  const Vec4d before = friction_impulse_;
  const Vec4d after_normal = velocity + normal * normal_response_;
  Vec4d after = before - (tangent_mass_.matrix * velocity + normal * friction_response_);
  sticks_ = limit > 0.0 && dot(after, after) <= limit * limit;
  if (!sticks_) {
    const Vec4d sliding = after_normal - dot(after_normal, normal_) * normal_;
    after = before - tangent_mass_.min * sliding;
    const double squared = dot(after, after);
    if (squared > limit * limit) after *= limit / std::sqrt(squared);
  }
  friction_impulse_ = after;
  const Vec4d change = after - before;
  *work_ += dot(change, after_normal + 0.5 * (mobility_ * change));
  return change;
}

double ContactImpulse::correct() {
  const Vec4d velocity = relative_velocity();
  const double normal = correct_normal(dot(velocity, normal_));
  Vec4d change = normal * normal_;
  // Sides that do not press, and did not, are left alone.
  if (friction_ > 0.0 && (normal_impulse_ > 0.0 || normal < 0.0)) {
    change += correct_friction(velocity, normal);
  } else {
    sticks_ = false;
  }
  const double size = sum_of_lanes(change < 0.0 ? -change : change);
  if (size > 0.0) apply(change);
  return size;
}

bool ContactImpulse::separate(double fraction) const {
  const double moved = dot(first_.position() - second_.position(), normal_) - start_distance_;
  const double left = fraction * depth_ - moved;
  if (!(left > 0.0)) return false;
  const double of_first = first_.inverse_mass() / (first_.inverse_mass() + second_.inverse_mass());
  first_.displace(of_first * left * normal_);
  second_.displace((of_first - 1.0) * left * normal_);
  return true;
}

}  // namespace pneuma::sim

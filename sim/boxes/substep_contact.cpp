#include "sim/boxes/substep_contact.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pneuma::sim {
namespace {

/// m/s, of boxes that lie in each other.
constexpr double max_parting = 1.0;
/// Over the points of a contact, each time: with one a box on its four corners trembles for long.
constexpr int iterations_of_points = 4;

Vec4d all(double value) { return Vec4d{value, value, value, value}; }

double clamp_to(double limit, double value) { return std::clamp(value, -limit, limit); }

}  // namespace

Softness soft_spring(double frequency, double damping_ratio, double step) {
  const double omega = 2.0 * std::numbers::pi * frequency;
  const double a = 2.0 * damping_ratio + step * omega;
  const double b = step * omega * a;
  return {omega / a, b / (1.0 + b), 1.0 / (1.0 + b)};
}

SubstepContact::SubstepContact(int first, int second, const SubstepBox& a, const SubstepBox& b,
                               const BoxContact& contact, double gap,
                               const ContactMaterial& material, double min_bounce)
    : normal_(to_vec4d(contact.normal)),
      offset_(a.centre - b.centre),
      friction_(material.friction),
      restitution_(material.restitution),
      first_(first),
      second_(second),
      count_(static_cast<std::size_t>(contact.count)) {
  for (std::size_t i = 0; i < count_; ++i) {
    const auto& [point, depth] = contact.all[i];
    arms_[i] = point - to_vec3(a.centre);
    const Vec4d turn = cross(to_vec4d(arms_[i]), normal_);
    const int lane = static_cast<int>(i);
    turns_x_[lane] = turn[0];
    turns_y_[lane] = turn[1];
    turns_z_[lane] = turn[2];
    distance_[lane] = -depth - gap;
  }
  find_normal_mass(a, b);
  find_centre_of_friction();
  find_friction_mass(a, b);
  if (restitution_ == 0.0) return;
  const Vec4d meets = along_normal(a.velocity, a.angular_velocity, b.velocity, b.angular_velocity,
                                   cross(offset_, normal_));
  for (int i = 0; i < static_cast<int>(count_); ++i) {
    if (restitution_ * meets[i] > -min_bounce) continue;
    approach_[i] = -meets[i];
    bounces_ = true;
  }
}

void SubstepContact::find_normal_mass(const SubstepBox& a, const SubstepBox& b) {
  const Vec4d more = cross(offset_, normal_);
  const Vec4d of_mass = all(a.inverse_mass + b.inverse_mass);
  for (std::size_t i = 0; i < count_; ++i) {
    const int lane = static_cast<int>(i);
    const Vec4d turn{turns_x_[lane], turns_y_[lane], turns_z_[lane], 0.0};
    const Vec4d of_first = a.inverse_inertia * turn;
    const Vec4d of_second = b.inverse_inertia * (turn + more);
    const Vec4d of_both = of_first + of_second;
    Vec4d column = of_mass + all(dot(more, of_second));
    column = fma(of_both[0], turns_x_, column);
    column = fma(of_both[1], turns_y_, column);
    column = fma(of_both[2], turns_z_, column);
    mobility_[i] = column;
    alone_[lane] = column[lane];
    mass_[lane] = 1.0 / column[lane];
  }
}

void SubstepContact::find_centre_of_friction() {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < count_; ++i) sum += arms_[i];
  const Vec3 centre = sum / static_cast<double>(count_);
  centre_ = to_vec4d(centre);
  for (std::size_t i = 0; i < count_; ++i) {
    lever_[static_cast<int>(i)] = (arms_[i] - centre).norm();
  }
}

void SubstepContact::find_friction_mass(const SubstepBox& a, const SubstepBox& b) {
  const Vec3 n = normal();
  tangent_ = to_vec4d(n.unitOrthogonal());
  other_tangent_ = cross(normal_, tangent_);
  const Vec4d second_centre = centre_ + offset_;
  const std::array<Vec4d, 2> along{tangent_, other_tangent_};
  std::array<Vec4d, 2> first{}, second{}, of_first{}, of_second{};
  for (const std::size_t k : {0U, 1U}) {
    first[k] = cross(centre_, along[k]);
    second[k] = cross(second_centre, along[k]);
    of_first[k] = a.inverse_inertia * first[k];
    of_second[k] = b.inverse_inertia * second[k];
  }
  const double of_mass = a.inverse_mass + b.inverse_mass;
  const double xx = of_mass + dot(first[0], of_first[0]) + dot(second[0], of_second[0]);
  const double yy = of_mass + dot(first[1], of_first[1]) + dot(second[1], of_second[1]);
  const double xy = dot(first[0], of_first[1]) + dot(second[0], of_second[1]);
  const double determinant = xx * yy - xy * xy;
  mass_xx_ = yy / determinant;
  mass_yy_ = xx / determinant;
  mass_xy_ = -xy / determinant;
  const Vec4d turn = a.inverse_inertia * normal_ + b.inverse_inertia * normal_;
  twist_mass_ = 1.0 / dot(normal_, turn);
}

/// Friction is divided among the points by what presses on them, and so that its moment is the
/// same.
SubstepContact::Impulses SubstepContact::impulses() const {
  Impulses result;
  result.fill(Vec3::Zero());
  const double sum = sum_of_lanes(impulse_);
  if (!(sum > 0.0)) return result;
  Vec3 pressed = Vec3::Zero();
  for (std::size_t i = 0; i < count_; ++i) {
    pressed += impulse_[static_cast<int>(i)] / sum * arms_[i];
  }
  double squared = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    squared += impulse_[static_cast<int>(i)] * (arms_[i] - pressed).squaredNorm();
  }
  const Vec3 n = normal(), friction = to_vec3(friction_impulse_);
  const double moment = twist_impulse_ - n.dot(Vec3(pressed - to_vec3(centre_)).cross(friction));
  const Vec3 turn = squared > 0.0 ? Vec3(moment / squared * n) : Vec3::Zero();
  for (std::size_t i = 0; i < count_; ++i) {
    const double normal_impulse = impulse_[static_cast<int>(i)];
    result[i] = normal_impulse * (n + friction / sum + turn.cross(arms_[i] - pressed));
  }
  return result;
}

void SubstepContact::start_from(const Impulses& impulses) {
  const Vec3 n = normal();
  Vec3 friction = Vec3::Zero();
  for (std::size_t i = 0; i < count_; ++i) {
    const double along = n.dot(impulses[i]);
    impulse_[static_cast<int>(i)] = std::max(0.0, along);
    const Vec3 across = impulses[i] - along * n;
    friction += across;
    twist_impulse_ += n.dot(Vec3(arms_[i] - to_vec3(centre_)).cross(across));
  }
  const double limit = friction_ * sum_of_lanes(impulse_), size = friction.norm();
  friction_impulse_ = to_vec4d(size > limit ? Vec3(limit / size * friction) : friction);
  twist_impulse_ = clamp_to(friction_ * sum_of_lanes(impulse_ * lever_), twist_impulse_);
}

/// X x n, with the boxes where they are now.
inline Vec4d SubstepContact::offset_normal(const SubstepBox& a, const SubstepBox& b) const {
  return cross(offset_ + a.moved - b.moved, normal_);
}

/// Of each point of the first box against that of the second, along the normal.
inline Vec4d SubstepContact::along_normal(Vec4d of_first, Vec4d turn_of_first, Vec4d of_second,
                                          Vec4d turn_of_second, Vec4d offset_normal) const {
  const Vec4d turn = turn_of_first - turn_of_second;
  const double common = dot(normal_, of_first - of_second) - dot(offset_normal, turn_of_second);
  return fma(turn[0], turns_x_, fma(turn[1], turns_y_, fma(turn[2], turns_z_, all(common))));
}

inline void SubstepContact::give(SubstepBox& a, SubstepBox& b, Vec4d impulses,
                                 Vec4d offset_normal) const {
  const Vec3x4 turns{impulses * turns_x_, impulses * turns_y_, impulses * turns_z_};
  const auto [first, second, third] = turns;
  const Vec4d xz_low = __builtin_shufflevector(first, third, 0, 4, 2, 6);
  const Vec4d xz_high = __builtin_shufflevector(first, third, 1, 5, 3, 7);
  const Vec4d y_low = __builtin_shufflevector(second, impulses, 0, 4, 2, 6);
  const Vec4d y_high = __builtin_shufflevector(second, impulses, 1, 5, 3, 7);
  const Vec4d xz = xz_low + xz_high, ys = y_low + y_high;  // x z x z, y s y s
  const Vec4d summed_xz = xz + __builtin_shufflevector(xz, xz, 2, 3, 0, 1);
  const Vec4d summed_ys = ys + __builtin_shufflevector(ys, ys, 2, 3, 0, 1);
  const double sum = summed_ys[1];
  const Vec4d turn{summed_xz[0], summed_ys[0], summed_xz[1], 0.0};
  a.velocity = fma(sum * a.inverse_mass, normal_, a.velocity);
  a.angular_velocity += a.inverse_inertia * turn;
  b.velocity = fma(-sum * b.inverse_mass, normal_, b.velocity);
  b.angular_velocity -= b.inverse_inertia * fma(sum, offset_normal, turn);
}

inline void SubstepContact::give_at_centre(SubstepBox& a, SubstepBox& b, Vec4d impulse) const {
  const Vec4d second_arm = centre_ + offset_ + a.moved - b.moved;
  a.velocity = fma(a.inverse_mass, impulse, a.velocity);
  a.angular_velocity += a.inverse_inertia * cross(centre_, impulse);
  b.velocity = fma(-b.inverse_mass, impulse, b.velocity);
  b.angular_velocity -= b.inverse_inertia * cross(second_arm, impulse);
}

inline void SubstepContact::twist(SubstepBox& a, SubstepBox& b, double moment) const {
  a.angular_velocity += a.inverse_inertia * (moment * normal_);
  b.angular_velocity -= b.inverse_inertia * (moment * normal_);
}

void SubstepContact::warm_start(SubstepBox& a, SubstepBox& b) const {
  give(a, b, impulse_, offset_normal(a, b));
  give_at_centre(a, b, friction_impulse_);
  twist(a, b, twist_impulse_);
}

/// What is wanted of each point: its change of impulse is
///   -mass (mass_scale u + bias) - impulse_scale impulse.
struct SubstepContact::Push {
  Vec4d bias, mass_scale, impulse_scale;
};

inline double SubstepContact::solve(SubstepBox& a, SubstepBox& b, const Push& push) {
  const Vec4d offset = offset_normal(a, b);
  Vec4d velocity =
      along_normal(a.velocity, a.angular_velocity, b.velocity, b.angular_velocity, offset);
  Vec4d impulse = impulse_;
  for (int iteration = 0; iteration < iterations_of_points; ++iteration) {
    for (std::size_t i = 0; i < count_; ++i) {
      const int k = static_cast<int>(i);
      const double less = mass_[k] * (push.mass_scale[k] * velocity[k] + push.bias[k]) +
                          push.impulse_scale[k] * impulse[k];
      const double given = std::max(-impulse[k], -less);
      velocity = fma(given, mobility_[i], velocity);
      impulse[k] += given;
    }
  }
  const Vec4d given = impulse - impulse_;
  impulse_ = impulse;
  give(a, b, given, offset);
  const Vec4d changed = max(given, -given) * alone_;
  return std::max(std::max(changed[0], changed[1]), std::max(changed[2], changed[3]));
}

double SubstepContact::push(SubstepBox& a, SubstepBox& b, const Softness& softness, double step) {
  const Vec4d way = along_normal(a.moved, a.turned, b.moved, b.turned, cross(offset_, normal_));
  const Vec4d distance = distance_ + way;
  pushed_distance_ = distance;
  const auto is_apart = distance > Vec4d{};
  const Vec4d parting = max(softness.mass_scale * softness.rate * distance, all(-max_parting));
  return solve(
      a, b,
      {is_apart ? distance / step : parting, is_apart ? all(1.0) : all(softness.mass_scale),
       is_apart ? Vec4d{} : all(softness.impulse_scale)});
}

double SubstepContact::parting_work(const SubstepBox& a, const SubstepBox& b, double step) const {
  const Vec4d way = along_normal(a.moved, a.turned, b.moved, b.turned, cross(offset_, normal_));
  const Vec4d before = min(pushed_distance_, Vec4d{}), now = min(distance_ + way, Vec4d{});
  return sum_of_lanes(impulse_ * max(now - before, Vec4d{})) / step;
}

double SubstepContact::relax(SubstepBox& a, SubstepBox& b, double step) {
  const Vec4d way = along_normal(a.moved, a.turned, b.moved, b.turned, cross(offset_, normal_));
  const double changed = solve(a, b, {max(distance_ + way, Vec4d{}) / step, all(1.0), Vec4d{}});
  greatest_impulse_ = max(greatest_impulse_, impulse_);
  rub(a, b);
  return changed;
}

inline void SubstepContact::rub(SubstepBox& a, SubstepBox& b) {
  const double limit = friction_ * sum_of_lanes(impulse_);
  if (limit == 0.0 && twist_impulse_ == 0.0 && dot(friction_impulse_, friction_impulse_) == 0.0) {
    return;
  }
  const double twist_limit = friction_ * sum_of_lanes(impulse_ * lever_);
  const double spin = dot(normal_, a.angular_velocity - b.angular_velocity);
  const double twisted = clamp_to(twist_limit, twist_impulse_ - twist_mass_ * spin);
  twist(a, b, twisted - twist_impulse_);
  twist_impulse_ = twisted;

  const Vec4d second_arm = centre_ + offset_ + a.moved - b.moved;
  const Vec4d slides = a.velocity - b.velocity + cross(a.angular_velocity, centre_) -
                       cross(b.angular_velocity, second_arm);
  const double x = dot(slides, tangent_), y = dot(slides, other_tangent_);
  Vec4d wanted = friction_impulse_ - (mass_xx_ * x + mass_xy_ * y) * tangent_ -
                 (mass_xy_ * x + mass_yy_ * y) * other_tangent_;
  const double squared = dot(wanted, wanted);
  if (squared > limit * limit) wanted = limit / std::sqrt(squared) * wanted;
  give_at_centre(a, b, wanted - friction_impulse_);
  friction_impulse_ = wanted;
}

void SubstepContact::bounce(SubstepBox& a, SubstepBox& b) {
  if (!bounces_) return;
  const auto met = greatest_impulse_ > Vec4d{};
  const Vec4d leaves = met ? restitution_ * approach_ : Vec4d{};
  const auto is_wanted = leaves > Vec4d{};
  // Other points of the contact stay as they are: nothing is asked of them.
  solve(a, b, {-leaves, is_wanted ? all(1.0) : Vec4d{}, Vec4d{}});
}

double SubstepContact::driven_work(const SubstepBox& a, const SubstepBox& b) const {
  if (!a.is_driven() && !b.is_driven()) return 0.0;
  const Vec4d second_arm = centre_ + offset_ + a.moved - b.moved;
  const Vec4d of_first = a.is_driven() ? a.velocity : Vec4d{};
  const Vec4d turn_of_first = a.is_driven() ? a.angular_velocity : Vec4d{};
  const Vec4d of_second = b.is_driven() ? b.velocity : Vec4d{};
  const Vec4d turn_of_second = b.is_driven() ? b.angular_velocity : Vec4d{};
  const Vec4d along =
      along_normal(of_first, turn_of_first, of_second, turn_of_second, offset_normal(a, b));
  const Vec4d across =
      of_first - of_second + cross(turn_of_first, centre_) - cross(turn_of_second, second_arm);
  return -sum_of_lanes(impulse_ * along) - dot(friction_impulse_, across) -
         twist_impulse_ * dot(normal_, turn_of_first - turn_of_second);
}

}  // namespace pneuma::sim

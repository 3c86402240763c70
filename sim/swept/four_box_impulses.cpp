#include "sim/swept/four_box_impulses.h"

#include <cmath>

namespace pneuma::sim {
namespace {

Vec4d dots(const Vec3x4& a, const Vec3x4& b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }

void set_lane(std::size_t lane, Vec4d vector, Vec3x4& of_all) {
  of_all.x[lane] = vector[0];
  of_all.y[lane] = vector[1];
  of_all.z[lane] = vector[2];
}

/// The sum over the axes.
Vec3x4 along(const std::array<Vec3x4, 3>& axes, const FourBoxImpulses::ByAxis& parts) {
  const auto sum = [&](Vec4d Vec3x4::*k) {
    return fma(axes[0].*k, parts[0], fma(axes[1].*k, parts[1], axes[2].*k * parts[2]));
  };
  return {sum(&Vec3x4::x), sum(&Vec3x4::y), sum(&Vec3x4::z)};
}

Vec3x4 read(const std::array<BoxChange*, 4>& boxes, Vec4d BoxChange::*part) {
  return to_columns(boxes[0]->*part, boxes[1]->*part, boxes[2]->*part, boxes[3]->*part);
}

void write(const Vec3x4& columns, const std::array<BoxChange*, 4>& boxes, Vec4d BoxChange::*part) {
  const std::array<Vec4d, 4> rows = to_rows(columns);
  for (std::size_t i = 0; i < 4; ++i) boxes[i]->*part = rows[i];
}

void add(const Vec3x4& more, Vec3x4& to) {
  to.x += more.x;
  to.y += more.y;
  to.z += more.z;
}

}  // namespace

FourMotions FourMotions::of(const std::array<BoxChange*, 4>& boxes) {
  return {read(boxes, &BoxChange::velocity), read(boxes, &BoxChange::angular_velocity)};
}

void FourMotions::give_back(const std::array<BoxChange*, 4>& boxes) const {
  write(velocity, boxes, &BoxChange::velocity);
  write(angular_velocity, boxes, &BoxChange::angular_velocity);
}

void FourBoxImpulses::Side::set(std::size_t lane, const SweptSide& side, double sign,
                                const std::array<Vec4d, 3>& axes) {
  const BoxChange* const box = side.box();
  if (!box) return;
  inverse_mass[lane] = sign * box->inverse_mass;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec4d lever = sign * cross(side.arm(), axes[i]);
    set_lane(lane, lever, levers[i]);
    set_lane(lane, box->inverse_inertia * lever, turns[i]);
  }
}

void FourBoxImpulses::Side::apply(const Vec3x4& whole, const ByAxis& impulse,
                                  FourMotions& motions) const {
  Vec3x4& velocity = motions.velocity;
  velocity.x = fma(inverse_mass, whole.x, velocity.x);
  velocity.y = fma(inverse_mass, whole.y, velocity.y);
  velocity.z = fma(inverse_mass, whole.z, velocity.z);
  add(along(turns, impulse), motions.angular_velocity);
}

void FourBoxImpulses::set(std::size_t lane, SweptImpulse& impulse) {
  const std::array axes = {impulse.normal_, impulse.tangent_,
                           cross(impulse.normal_, impulse.tangent_)};
  for (std::size_t i = 0; i < 3; ++i) set_lane(lane, axes[i], axes_[i]);
  first_.set(lane, impulse.first_, 1.0, axes);
  second_.set(lane, impulse.second_, -1.0, axes);
  normal_mass_[lane] = impulse.normal_mass_;
  min_tangent_mass_[lane] = impulse.min_tangent_mass_;
  mobility_[lane] = impulse.mobility_;
  friction_[lane] = impulse.friction_;
  impulses_[lane] = &impulse;
}

void FourBoxImpulses::begin() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    by_normal_[axis] =
        dots(first_.levers[axis], first_.turns[0]) + dots(second_.levers[axis], second_.turns[0]);
    direction_[axis] = correction_[axis] = Vec4d{};
  }
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const SweptImpulse* const impulse = impulses_[lane];
    if (!impulse) continue;
    parting_[lane] = impulse->parting_;
    max_normal_[lane] = impulse->max_normal_;
    impulse_[0][lane] = impulse->normal_impulse_;
    const Vec4d tangent = impulse->tangent_, other = cross(impulse->normal_, tangent);
    sliding_[1][lane] = dot(impulse->sliding_, tangent);
    sliding_[2][lane] = dot(impulse->sliding_, other);
    impulse_[1][lane] = dot(impulse->friction_impulse_, tangent);
    impulse_[2][lane] = dot(impulse->friction_impulse_, other);
  }
}

void FourBoxImpulses::end() const {
  for (std::size_t lane = 0; lane < 4; ++lane) {
    SweptImpulse* const impulse = impulses_[lane];
    if (!impulse) continue;
    impulse->normal_impulse_ = impulse_[0][lane];
    const Vec4d tangent = impulse->tangent_, other = cross(impulse->normal_, tangent);
    impulse->friction_impulse_ = impulse_[1][lane] * tangent + impulse_[2][lane] * other;
  }
}

/// As SweptImpulse's, with friction in two directions across the normal. What the normal impulse
/// changes across it is added to what there was, so that friction need not wait for the boxes.
void FourBoxImpulses::correct(double ratio, FourMotions& first, FourMotions& second,
                              Change& change) {
  go_on(ratio);
  const Vec3x4 &one = first.velocity, &other = second.velocity;
  const Vec3x4 velocity{one.x - other.x, one.y - other.y, one.z - other.z};
  const auto slides = [&](std::size_t axis) {
    return dots(axes_[axis], velocity) + dots(first_.levers[axis], first.angular_velocity) +
           dots(second_.levers[axis], second.angular_velocity);
  };
  const Vec4d tried = fma(parting_ - slides(0), normal_mass_, impulse_[0]);
  const Vec4d normal = min(max(tried, Vec4d{}), max_normal_);
  const Vec4d given = normal - impulse_[0];
  const auto rub = [&](std::size_t axis) {
    const Vec4d slid = fma(given, by_normal_[axis], slides(axis) + sliding_[axis]);
    return impulse_[axis] - min_tangent_mass_ * slid;
  };
  ByAxis after{normal, rub(1), rub(2)};
  const Vec4d limit = friction_ * normal, squared_limit = limit * limit;
  const Vec4d squared = fma(after[1], after[1], after[2] * after[2]);
  if (!all_of_lanes(squared <= squared_limit)) {
    const Vec4d one_of_each = {1.0, 1.0, 1.0, 1.0};
    const Vec4d shorter = squared > squared_limit ? limit / square_root(squared) : one_of_each;
    after[1] *= shorter;
    after[2] *= shorter;
  }
  for (std::size_t i = 0; i < 3; ++i) correction_[i] = after[i] - impulse_[i];
  impulse_ = after;
  const Vec3x4 whole = along(axes_, correction_);
  first_.apply(whole, correction_, first);
  second_.apply(whole, correction_, second);
  const Vec4d by_normal = given * mobility_, along_normal = given * given;
  const Vec4d across = fma(correction_[1], correction_[1], correction_[2] * correction_[2]);
  const Vec4d by_friction = across / (min_tangent_mass_ * min_tangent_mass_);
  change.squared_velocity = max(change.squared_velocity, max(by_normal * by_normal, by_friction));
  change.energy = fma(mobility_, along_normal + across, change.energy);
}

void FourBoxImpulses::go_on(double ratio) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec4d more = ratio * direction_[i];
    direction_[i] = more + correction_[i];
    impulse_[i] += more;
  }
}

}  // namespace pneuma::sim

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

/// Zero of what nothing moves.
template <class Part>
Vec3x4 read(const std::array<BoxChange*, 4>& boxes, Part BoxChange::*part) {
  const auto row = [&](std::size_t i) { return boxes[i] ? boxes[i]->*part : Vec4d{}; };
  return to_columns(row(0), row(1), row(2), row(3));
}

void add(const Vec3x4& more, const std::array<BoxChange*, 4>& boxes, Vec4d BoxChange::*part) {
  const std::array<Vec4d, 4> rows = to_rows(more);
  for (std::size_t i = 0; i < 4; ++i) {
    if (boxes[i]) boxes[i]->*part += rows[i];
  }
}

}  // namespace

void FourBoxImpulses::Side::set(std::size_t lane, const SweptSide& side, double sign,
                                const std::array<Vec4d, 3>& axes) {
  BoxChange* const box = boxes[lane] = side.box();
  if (!box) return;
  inverse_mass[lane] = sign * box->inverse_mass;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec4d lever = sign * cross(side.arm(), axes[i]);
    set_lane(lane, lever, levers[i]);
    set_lane(lane, box->inverse_inertia * lever, turns[i]);
  }
}

Vec3x4 FourBoxImpulses::Side::velocity() const { return read(boxes, &BoxChange::velocity); }

Vec3x4 FourBoxImpulses::Side::angular_velocity() const {
  return read(boxes, &BoxChange::angular_velocity);
}

void FourBoxImpulses::Side::apply(const Vec3x4& whole, const ByAxis& impulse) const {
  const Vec3x4 faster{inverse_mass * whole.x, inverse_mass * whole.y, inverse_mass * whole.z};
  add(faster, boxes, &BoxChange::velocity);
  add(along(turns, impulse), boxes, &BoxChange::angular_velocity);
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
void FourBoxImpulses::correct(Change& change) {
  const Vec3x4 one = first_.velocity(), other = second_.velocity();
  const Vec3x4 velocity{one.x - other.x, one.y - other.y, one.z - other.z};
  const Vec3x4 first_spin = first_.angular_velocity(), second_spin = second_.angular_velocity();
  const auto slides = [&](std::size_t axis) {
    return dots(axes_[axis], velocity) + dots(first_.levers[axis], first_spin) +
           dots(second_.levers[axis], second_spin);
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
  apply(correction_);
  const Vec4d by_normal = given * mobility_, along_normal = given * given;
  const Vec4d across = fma(correction_[1], correction_[1], correction_[2] * correction_[2]);
  const Vec4d by_friction = across / (min_tangent_mass_ * min_tangent_mass_);
  change.squared_velocity = max(change.squared_velocity, max(by_normal * by_normal, by_friction));
  change.energy = fma(mobility_, along_normal + across, change.energy);
}

void FourBoxImpulses::go_on(bool grows, double ratio) {
  ByAxis more;
  for (std::size_t i = 0; i < 3; ++i) {
    more[i] = ratio * direction_[i];
    direction_[i] = more[i] + correction_[i];
  }
  if (grows) return;
  for (std::size_t i = 0; i < 3; ++i) impulse_[i] += more[i];
  apply(more);
}

void FourBoxImpulses::apply(const ByAxis& impulse) const {
  const Vec3x4 whole = along(axes_, impulse);
  first_.apply(whole, impulse);
  second_.apply(whole, impulse);
}

}  // namespace pneuma::sim

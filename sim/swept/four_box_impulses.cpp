#include "sim/swept/four_box_impulses.h"

#include <cmath>

namespace pneuma::sim {
namespace {

Vec4d dots(const Vec3x4& a, const Vec3x4& b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }

/// As those of single vectors, to the bit.
Vec4d plain_dots(const Vec3x4& a, const Vec3x4& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Vec3x4 crosses(const Vec3x4& a, const Vec3x4& b) {
  return {fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)), fma(a.x, b.y, -(a.y * b.x))};
}

Vec3x4 operator*(double factor, const Vec3x4& v) {
  return {factor * v.x, factor * v.y, factor * v.z};
}

/// `part` of each in its lane, or zero where there is none.
template <class One, class Part>
Vec3x4 columns_of(const std::array<One*, 4>& all, const Part& part) {
  const auto row = [&](std::size_t i) { return all[i] ? part(*all[i]) : Vec4d{}; };
  return to_columns(row(0), row(1), row(2), row(3));
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

void FourBoxImpulses::Side::set(const std::array<const SweptSide*, 4>& sides, double sign,
                                const std::array<Vec3x4, 3>& axes) {
  std::array<const BoxChange*, 4> boxes{};
  for (std::size_t lane = 0; lane < 4; ++lane) {
    boxes[lane] = sides[lane] ? sides[lane]->box() : nullptr;
    inverse_mass[lane] = boxes[lane] ? sign * boxes[lane]->inverse_mass : 0.0;
  }
  const auto column = [&](std::size_t k) {
    return columns_of(boxes, [k](const BoxChange& box) { return box.inverse_inertia.columns[k]; });
  };
  const std::array inertia = {column(0), column(1), column(2)};
  const Vec3x4 arms = columns_of(sides, [](const SweptSide& side) { return side.arm(); });
  for (std::size_t i = 0; i < 3; ++i) {
    levers[i] = sign * crosses(arms, axes[i]);
    turns[i] = along(inertia, {levers[i].x, levers[i].y, levers[i].z});
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

void FourBoxImpulses::set(const std::array<SweptImpulse*, 4>& impulses) {
  impulses_ = impulses;
  axes_[0] = columns_of(impulses, [](const SweptImpulse& one) { return one.normal_; });
  axes_[1] = columns_of(impulses, [](const SweptImpulse& one) { return one.tangent_; });
  axes_[2] = crosses(axes_[0], axes_[1]);
  std::array<const SweptSide*, 4> first{}, second{};
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const SweptImpulse* const impulse = impulses[lane];
    if (!impulse) continue;
    first[lane] = &impulse->first_;
    second[lane] = &impulse->second_;
    normal_mass_[lane] = impulse->normal_mass_;
    min_tangent_mass_[lane] = impulse->min_tangent_mass_;
    mobility_[lane] = impulse->mobility_;
    friction_[lane] = impulse->friction_;
  }
  first_.set(first, 1.0, axes_);
  second_.set(second, -1.0, axes_);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    by_normal_[axis] =
        dots(first_.levers[axis], first_.turns[0]) + dots(second_.levers[axis], second_.turns[0]);
  }
}

void FourBoxImpulses::begin() {
  direction_ = correction_ = ByAxis{};
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const SweptImpulse* const impulse = impulses_[lane];
    if (!impulse) continue;
    parting_[lane] = impulse->parting_;
    max_normal_[lane] = impulse->max_normal_;
    squeeze_[lane] = impulse->squeeze_;
    impulse_[0][lane] = impulse->normal_impulse_;
  }
  const Vec3x4 sliding =
      columns_of(impulses_, [](const SweptImpulse& one) { return one.sliding_; });
  const Vec3x4 friction =
      columns_of(impulses_, [](const SweptImpulse& one) { return one.friction_impulse_; });
  for (std::size_t axis = 1; axis < 3; ++axis) {
    sliding_[axis] = plain_dots(sliding, axes_[axis]);
    impulse_[axis] = plain_dots(friction, axes_[axis]);
  }
}

void FourBoxImpulses::end() const {
  const auto part = [&](Vec4d Vec3x4::*k) {
    return impulse_[1] * axes_[1].*k + impulse_[2] * axes_[2].*k;
  };
  const std::array<Vec4d, 4> friction =
      to_rows({part(&Vec3x4::x), part(&Vec3x4::y), part(&Vec3x4::z)});
  for (std::size_t lane = 0; lane < 4; ++lane) {
    SweptImpulse* const impulse = impulses_[lane];
    if (!impulse) continue;
    impulse->normal_impulse_ = impulse_[0][lane];
    impulse->friction_impulse_ = friction[lane];
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
  const Vec4d limit = friction_ * (normal + squeeze_), squared_limit = limit * limit;
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

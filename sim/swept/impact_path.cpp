#include "sim/swept/impact_path.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {
namespace {

/// Until nothing approaches, and as many until all is returned, if friction takes no part in it.
constexpr int parts = 16;
/// Friction may turn most of the motion: then more is returned along the normal than by Newton.
constexpr int max_returning_parts = 4 * parts;
constexpr int max_iterations = 200;
constexpr double tolerance_of_part = 1e-3;  // of its change of velocity
constexpr double tolerance_at_once = 1e-9;  // of the greatest approach

double speed(const ImpactPoint& point) {
  return point.speed + point.impulse->normal().dot(point.impulse->change());
}

double max_approach(std::span<const ImpactPoint> points) {
  double most = 0.0;
  for (const ImpactPoint& point : points) most = std::max(most, point.approach);
  return most;
}

}  // namespace

void ImpactPath::follow(std::span<const ImpactPoint> points, double restitution,
                        double max_tolerance) {
  const double tolerance =
      std::min(max_tolerance, tolerance_of_part * max_approach(points) / parts);
  begin(points);
  // What the sides gained in the step after they met is stopped, and nothing of it returned.
  add_part(points, -1.0, tolerance);
  keep_part(points);
  double taken = 0.0;
  for (int part = parts - 1; part >= 0; --part) {
    taken -= add_part(points, -static_cast<double>(part) / parts, tolerance);
    keep_part(points);
  }
  double to_return = restitution * restitution * taken;
  for (int part = 1; part <= max_returning_parts && to_return > 0.0; ++part) {
    const double returned = add_part(points, restitution * part / parts, tolerance);
    if (returned > to_return) shorten_part(points, to_return);
    keep_part(points);
    to_return -= returned;
  }
  end(points);
}

void ImpactPath::part_at_once(std::span<const ImpactPoint> points, double restitution,
                              double max_tolerance) {
  const double tolerance = std::min(max_tolerance, tolerance_at_once * max_approach(points));
  begin(points);
  add_part(points, restitution, tolerance);
}

void ImpactPath::begin(std::span<const ImpactPoint> points) {
  states_.assign(points.size(), {});
  impulses_.clear();
  for (const ImpactPoint& point : points) {
    impulses_.push_back(point.impulse);
    point.impulse->replace_given(to_vec4d(point.impulse->given()) - point.impulse->impulse());
  }
  iterations_.begin(impulses_);
}

/// Until the points that are hit part at `share` of the speed with which they were. Returns the
/// work of the normal impulses, J: they grow as the speeds do.
double ImpactPath::add_part(std::span<const ImpactPoint> points, double share, double tolerance) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ImpactPoint& point = points[i];
    states_[i].speed = speed(point);
    states_[i].given = point.impulse->given();
    const double parting = point.approach > 0.0 ? share * point.approach : point.parting;
    point.impulse->aim(parting - point.speed, point.velocity);
  }
  iterations_.correct(tolerance, max_iterations);
  double work = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    work += 0.5 * (states_[i].speed + speed(points[i])) * points[i].impulse->normal_impulse();
  }
  return work;
}

/// Takes as much of a part that its normal impulses do that work, J: less than they did.
void ImpactPath::shorten_part(std::span<const ImpactPoint> points, double work) {
  double linear = 0.0, quadratic = 0.0;  // of the work, in the fraction of the part
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double normal = points[i].impulse->normal_impulse(), before = states_[i].speed;
    linear += normal * before;
    quadratic += 0.5 * normal * (speed(points[i]) - before);
  }
  const double root = std::sqrt(std::max(0.0, linear * linear + 4.0 * quadratic * work));
  const double fraction = std::clamp(2.0 * work / (linear + root), 0.0, 1.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 before = states_[i].given, part = points[i].impulse->given() - before;
    points[i].impulse->replace_given(to_vec4d(before + fraction * part));
  }
}

/// The next part is limited by itself.
void ImpactPath::keep_part(std::span<const ImpactPoint> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double normal = points[i].impulse->normal_impulse();
    const Vec3 friction = points[i].impulse->friction_impulse();
    states_[i].normal += normal;
    states_[i].friction += friction;
    points[i].impulse->count_from(normal, friction);
  }
}

void ImpactPath::end(std::span<const ImpactPoint> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].impulse->count_from(-states_[i].normal, -states_[i].friction);
  }
}

}  // namespace pneuma::sim

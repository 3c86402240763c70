#include "assets/cat/cat_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace pneuma::assets {
namespace {

/// A ball that moves from one place to another while its radius changes.
struct Part {
  Vec3 from;
  double from_radius;
  Vec3 to;
  double to_radius;
  double blend;         // m, over which it flows into what came before it
  bool pair;            // there is one on the other side too, at -y
  double spacing;       // see cat_spacing
  double height = 1.0;  // the balls, over their width
};

/// From large to small, because each part flows into the ones above it.
const std::array parts = {
    // trunk: chest to belly, belly to hips
    Part{{0.40, 0.00, 0.80}, 0.245, {-0.05, 0.00, 0.77}, 0.235, 0.00, false, 1.0},
    Part{{-0.05, 0.00, 0.77}, 0.235, {-0.46, 0.00, 0.80}, 0.235, 0.10, false, 1.0},
    // neck
    Part{{0.44, 0.00, 0.90}, 0.18, {0.62, 0.00, 1.10}, 0.155, 0.10, false, 1.0},
    // thighs and shoulders
    Part{{-0.48, 0.12, 0.72}, 0.175, {-0.40, 0.165, 0.48}, 0.125, 0.10, true, 0.9},
    Part{{0.40, 0.12, 0.72}, 0.150, {0.38, 0.17, 0.45}, 0.105, 0.10, true, 0.9},
    // hind legs: knee to heel, heel to paw, paw
    Part{{-0.40, 0.165, 0.48}, 0.120, {-0.60, 0.19, 0.28}, 0.085, 0.05, true, 0.8},
    Part{{-0.60, 0.19, 0.28}, 0.085, {-0.53, 0.20, 0.10}, 0.085, 0.03, true, 0.8},
    Part{{-0.53, 0.20, 0.066}, 0.11, {-0.40, 0.20, 0.066}, 0.11, 0.03, true, 0.75, 0.6},
    // fore legs: elbow to wrist, paw
    Part{{0.38, 0.17, 0.45}, 0.100, {0.40, 0.19, 0.10}, 0.085, 0.05, true, 0.8},
    Part{{0.39, 0.20, 0.066}, 0.11, {0.50, 0.20, 0.066}, 0.11, 0.03, true, 0.75, 0.6},
    // head: skull, cheeks, muzzle
    Part{{0.70, -0.07, 1.20}, 0.205, {0.70, 0.07, 1.20}, 0.205, 0.06, false, 0.9},
    Part{{0.75, 0.13, 1.12}, 0.115, {0.75, 0.13, 1.12}, 0.115, 0.08, true, 0.9},
    Part{{0.80, 0.03, 1.12}, 0.105, {0.91, 0.03, 1.10}, 0.085, 0.03, true, 0.65},
    // ears: two edges of a triangle from its base to its tip
    Part{{0.67, 0.08, 1.35}, 0.085, {0.655, 0.200, 1.575}, 0.050, 0.02, true, 0.65},
    Part{{0.67, 0.175, 1.29}, 0.085, {0.655, 0.200, 1.575}, 0.050, 0.02, true, 0.65},
    // tail: out of the rump, up in a bow, and forward again at its end
    Part{{-0.60, 0.00, 0.86}, 0.105, {-0.78, 0.00, 0.94}, 0.092, 0.10, false, 0.8},
    Part{{-0.78, 0.00, 0.94}, 0.092, {-0.91, 0.00, 1.08}, 0.090, 0.03, false, 0.65},
    Part{{-0.91, 0.00, 1.08}, 0.090, {-0.96, 0.00, 1.27}, 0.088, 0.03, false, 0.65},
    Part{{-0.96, 0.00, 1.27}, 0.088, {-0.91, 0.00, 1.46}, 0.086, 0.03, false, 0.65},
    Part{{-0.91, 0.00, 1.46}, 0.086, {-0.79, 0.00, 1.57}, 0.085, 0.03, false, 0.65},
};

Vec3 mirrored(const Vec3& point) { return {point.x(), -point.y(), point.z()}; }

/// A part with all that can be known of it before any point is.
struct Limb {
  explicit Limb(const Part& part)
      : from(part.from),
        radius(part.from_radius),
        blend(part.blend),
        spacing(part.spacing),
        stretch(1.0, 1.0, 1.0 / part.height),
        centre(0.5 * (part.from + part.to)) {
    const Vec3 axis = part.to - part.from;
    length = axis.norm();
    reach = 0.5 * length + std::max(part.from_radius, part.to_radius);
    if (length == 0.0) return;
    along = axis / length;
    taper = (part.from_radius - part.to_radius) / length;
    slant = taper / std::sqrt(1.0 - taper * taper);
  }

  Vec3 from;
  double radius, blend, spacing;
  Vec3 stretch;
  Vec3 centre;
  double length = 0.0;
  double reach;  // of the whole part from its centre
  Vec3 along = Vec3::Zero();
  double taper = 0.0, slant = 0.0;
};

std::vector<Limb> make_limbs() {
  std::vector<Limb> limbs;
  for (Part part : parts) {
    limbs.emplace_back(part);
    if (!part.pair) continue;
    part.from = mirrored(part.from);
    part.to = mirrored(part.to);
    limbs.emplace_back(part);
  }
  return limbs;
}

const std::vector<Limb>& limbs() {
  static const std::vector<Limb> all = make_limbs();
  return all;
}

/// False only if the limb is further away than `distance`.
bool may_be_within(const Limb& limb, const Vec3& point, double distance) {
  const double far = limb.reach + distance;
  return far > 0.0 && (point - limb.centre).squaredNorm() < far * far;
}

/// With s along the axis, a part is the union of balls of radius r(s) = r0 - g s. A point at height
/// u along the axis and at distance w from it is nearest to the ball at s where d/ds (|p - c(s)| -
/// r(s)) = 0: s = u - g w / sqrt(1 - g^2), cut to the axis.
///
/// The gradient is that to this ball alone, because moving the ball changes nothing in first order.
Distance distance_to(const Limb& limb, const Vec3& point) {
  const Vec3 arm = limb.stretch.cwiseProduct(point - limb.from);
  const double u = arm.dot(limb.along);
  const double w = (arm - u * limb.along).norm();
  const double s = std::clamp(u - limb.slant * w, 0.0, limb.length);
  const Vec3 from_centre = arm - s * limb.along;
  const double distance = from_centre.norm();
  return {distance - (limb.radius - limb.taper * s),
          limb.stretch.cwiseProduct(from_centre) / distance};
}

/// The lesser of two distances, rounded off where they differ by less than `blend`; twice
/// continuously differentiable.
Distance smooth_min(const Distance& a, const Distance& b, double blend) {
  const Distance& nearer = a.value < b.value ? a : b;
  const Distance& farther = a.value < b.value ? b : a;
  const double near = blend - (farther.value - nearer.value);
  if (!(near > 0.0)) return nearer;
  const double fraction = near / blend;
  return {nearer.value - fraction * fraction * fraction * blend / 6.0,
          nearer.gradient + 0.5 * fraction * fraction * (farther.gradient - nearer.gradient)};
}

double smooth_step(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

Distance cat_distance(const Vec3& point) {
  Distance distance{std::numeric_limits<double>::infinity(), Vec3::Zero()};
  for (const Limb& limb : limbs()) {
    if (!may_be_within(limb, point, distance.value + limb.blend)) continue;  // would change nothing
    distance = smooth_min(distance, distance_to(limb, point), limb.blend);
  }
  return distance;
}

Vec3 project_to_cat(const Vec3& point) {
  constexpr double near_enough = 1e-9;  // m, a thousandth of the last digit written
  Vec3 result = point;
  for (int i = 0; i < 20; ++i) {  // Newton's method
    const auto [value, gradient] = cat_distance(result);
    if (std::abs(value) < near_enough) break;
    result -= value / std::max(gradient.squaredNorm(), 0.1) * gradient;
  }
  return result;
}

double cat_spacing(const Vec3& point) {
  constexpr double range = 0.15;  // m, over which the spacing grows to the trunk's
  double spacing = 1.0;
  for (const Limb& limb : limbs()) {
    if (limb.spacing >= spacing || !may_be_within(limb, point, range)) continue;
    const double away = smooth_step(distance_to(limb, point).value / range);
    spacing = std::min(spacing, limb.spacing + (1.0 - limb.spacing) * away);
  }
  return spacing;
}

}  // namespace pneuma::assets

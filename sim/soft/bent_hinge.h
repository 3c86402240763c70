// One hinge as it is bent now: what the forces and second derivatives of bending.h are made of.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/mesh/hinges.h"
#include "sim/mesh/vec4d.h"

namespace pneuma::sim {

/// s of a triangle (bending.h) of this fraction of its area at rest: odd, so that E is smooth where
/// a triangle turns over, and smooth to the second derivative where it reaches 1.
class NormalWeight {
 public:
  explicit NormalWeight(double area_fraction)
      : a_(area_fraction / flat_fraction), rest_(1.0 - a_ * a_) {}

  /// Of the area at rest: below, the normal of a triangle counts for less.
  static constexpr double flat_fraction = 0.8;

  double value() const { return a_ * (1.875 + a_ * a_ * (-1.25 + 0.375 * a_ * a_)); }
  double slope() const { return 1.875 / flat_fraction * rest_ * rest_; }
  double curvature() const { return -7.5 / (flat_fraction * flat_fraction) * a_ * rest_; }

 private:
  double a_, rest_;
};

struct BentHinge {
  Vec4d edge;                                      // b - a
  Vec4d to_first, to_second;                       // from a to c and d
  Vec4d first, second;                             // twice the area vectors of the triangles
  double squared_first, squared_second;            // of their lengths
  std::array<double, 2> areas = {};                // at rest
  double length = 0.0;                             // of the edge
  HingeAngle angle;                                // t
  double cosine = 1.0, sine = 0.0;                 // of t - t0
  double first_weight = 1.0, second_weight = 1.0;  // s1, s2

  double weight() const { return first_weight * second_weight; }
  /// Whether a triangle has no normal.
  bool is_flat() const { return !(squared_first > 0.0 && squared_second > 0.0); }
};

/// Of a triangle, over that at rest. `squared`: of twice the area.
inline double area_fraction(double squared, double at_rest) {
  return 0.5 * std::sqrt(squared) / at_rest;
}

inline double normal_weight(double squared, double at_rest) {
  const double flat = 2.0 * NormalWeight::flat_fraction * at_rest;
  return squared < flat * flat ? NormalWeight(area_fraction(squared, at_rest)).value() : 1.0;
}

inline BentHinge bend(const HingeTable& hinges, std::size_t e, const VertexReader& x) {
  const HingeTable::Corners& corners = hinges.corners[e];
  const HingeAngle& rest = hinges.rest[e];
  BentHinge bent;
  const Vec4d a = x[corners[0]];
  bent.edge = x[corners[1]] - a;
  bent.to_first = x[corners[2]] - a;
  bent.to_second = x[corners[3]] - a;
  bent.first = cross(bent.edge, bent.to_first);
  bent.second = cross(bent.to_second, bent.edge);
  bent.squared_first = dot(bent.first, bent.first);
  bent.squared_second = dot(bent.second, bent.second);
  bent.areas = hinges.areas[e];
  bent.first_weight = normal_weight(bent.squared_first, bent.areas[0]);
  bent.second_weight = normal_weight(bent.squared_second, bent.areas[1]);
  if (bent.is_flat()) return bent;
  bent.length = std::sqrt(dot(bent.edge, bent.edge));
  const double scale = 1.0 / std::sqrt(bent.squared_first * bent.squared_second);
  const double cosine = scale * dot(bent.first, bent.second);
  const double sine = scale / bent.length * dot(cross(bent.first, bent.second), bent.edge);
  bent.angle = {cosine, sine};
  bent.cosine = cosine * rest.cosine + sine * rest.sine;
  bent.sine = sine * rest.cosine - cosine * rest.sine;
  return bent;
}

/// f of bending.h.
inline double dashpot_fraction(const BentHinge& bent) {
  constexpr double whole = 0.9;
  const double area = std::min(area_fraction(bent.squared_first, bent.areas[0]),
                               area_fraction(bent.squared_second, bent.areas[1]));
  constexpr double flat = NormalWeight::flat_fraction;
  return std::clamp((area - flat) / (whole - flat), 0.0, 1.0);
}

/// Derivatives by the positions of the four corners.
struct HingeGradient {
  Vec4d a, b, c, d;
};

/// dt/dx. A triangle turns about the edge when its third corner moves along its normal, by 1 /
/// height; the ends of the edge take the opposite of that, each by how near it is.
inline HingeGradient angle_gradient(const BentHinge& bent) {
  const Vec4d first = (bent.length / bent.squared_first) * bent.first;
  const Vec4d second = (bent.length / bent.squared_second) * bent.second;
  const double squared = bent.length * bent.length;
  const double f = dot(bent.to_first, bent.edge) / squared;
  const double s = dot(bent.to_second, bent.edge) / squared;
  return {(1.0 - f) * first + (1.0 - s) * second, f * first + s * second, -first, -second};
}

/// d(s1 s2)/dx. The area of a triangle grows most when a corner moves away from the edge across it.
inline HingeGradient weight_gradient(const BentHinge& bent) {
  HingeGradient result{};
  const auto scaled = [](const Vec4d& normal, double squared, double at_rest, double other) {
    const double slope = NormalWeight(area_fraction(squared, at_rest)).slope();
    return (0.5 * other * slope / (at_rest * std::sqrt(squared))) * normal;
  };
  if (bent.first_weight < 1.0) {
    const Vec4d normal = scaled(bent.first, bent.squared_first, bent.areas[0], bent.second_weight);
    result.a += cross(bent.edge - bent.to_first, normal);
    result.b += cross(bent.to_first, normal);
    result.c = cross(normal, bent.edge);
  }
  if (bent.second_weight < 1.0) {
    const Vec4d normal = scaled(bent.second, bent.squared_second, bent.areas[1], bent.first_weight);
    result.a += cross(bent.to_second - bent.edge, normal);
    result.b += cross(normal, bent.to_second);
    result.d = cross(bent.edge, normal);
  }
  return result;
}

}  // namespace pneuma::sim

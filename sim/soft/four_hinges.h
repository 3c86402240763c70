// Four hinges at a time, in the lanes of Vec4d.
#pragma once

#include <array>
#include <cstddef>

#include "sim/soft/bent_hinge.h"

namespace pneuma::sim {

inline Vec3x4 operator-(const Vec3x4& a, const Vec3x4& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3x4 operator+(const Vec3x4& a, const Vec3x4& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3x4 operator*(Vec4d factors, const Vec3x4& v) {
  return {factors * v.x, factors * v.y, factors * v.z};
}
inline Vec4d dot(const Vec3x4& a, const Vec3x4& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3x4 cross(const Vec3x4& a, const Vec3x4& b) {
  return {fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)), fma(a.x, b.y, -(a.y * b.x))};
}

/// bend() and angle_gradient() of bent_hinge.h, to the last bit, of hinges whose triangles all have
/// normals that count in full.
class FourHinges {
 public:
  /// Of the hinge `e` and the three after it.
  FourHinges(const HingeTable& hinges, std::size_t e, const VertexReader& x) {
    const HingeTable::Corners* const corners = &hinges.corners[e];
    const auto column = [&](std::size_t i) {
      return to_columns(x[corners[0][i]], x[corners[1][i]], x[corners[2][i]], x[corners[3][i]]);
    };
    const Vec3x4 a = column(0);
    edge_ = column(1) - a;
    to_first_ = column(2) - a;
    to_second_ = column(3) - a;
    first_ = cross(edge_, to_first_);
    second_ = cross(to_second_, edge_);
    squared_first_ = dot(first_, first_);
    squared_second_ = dot(second_, second_);
  }

  /// Whether the rest means anything.
  bool have_whole_normals(const HingeTable& hinges, std::size_t e) const {
    const Pair areas = load_pairs(hinges.areas[e].data());
    const auto squared_flat = [](Vec4d at_rest) {
      const Vec4d flat = 2.0 * NormalWeight::flat_fraction * at_rest;
      return flat * flat;
    };
    return all_of_lanes(squared_first_ >= squared_flat(areas.first)) &&
           all_of_lanes(squared_second_ >= squared_flat(areas.second));
  }

  /// Of t - t0.
  struct Turn {
    Vec4d cosine, sine;
  };
  Turn turn(const HingeTable& hinges, std::size_t e) const {
    const Vec4d scale = 1.0 / square_root(squared_first_ * squared_second_);
    const Vec4d cosine = scale * dot(first_, second_);
    const Vec4d sine = scale / length() * dot(cross(first_, second_), edge_);
    const Pair rest = load_pairs(&hinges.rest[e].cosine);
    return {cosine * rest.first + sine * rest.second, sine * rest.first - cosine * rest.second};
  }

  /// dt/dx of each.
  std::array<HingeGradient, 4> gradients() const {
    const Vec4d edge_length = length(), squared = edge_length * edge_length;
    const Vec3x4 first = (edge_length / squared_first_) * first_;
    const Vec3x4 second = (edge_length / squared_second_) * second_;
    const Vec4d f = dot(to_first_, edge_) / squared, s = dot(to_second_, edge_) / squared;
    const auto a = to_rows((1.0 - f) * first + (1.0 - s) * second);
    const auto b = to_rows(f * first + s * second);
    const auto c = to_rows(first), d = to_rows(second);
    return {{{a[0], b[0], -c[0], -d[0]},
             {a[1], b[1], -c[1], -d[1]},
             {a[2], b[2], -c[2], -d[2]},
             {a[3], b[3], -c[3], -d[3]}}};
  }

 private:
  struct Pair {
    Vec4d first, second;
  };
  /// Two numbers of each hinge stand together.
  static Pair load_pairs(const double* from) {
    const Vec4d low = load_vec4d(from), high = load_vec4d(from + 4);
    return {__builtin_shufflevector(low, high, 0, 2, 4, 6),
            __builtin_shufflevector(low, high, 1, 3, 5, 7)};
  }
  Vec4d length() const { return square_root(dot(edge_, edge_)); }

  Vec3x4 edge_;                           // b - a
  Vec3x4 to_first_, to_second_;           // from a to c and d
  Vec3x4 first_, second_;                 // twice the area vectors of the triangles
  Vec4d squared_first_, squared_second_;  // of their lengths
};

}  // namespace pneuma::sim

// Four doubles that are added and multiplied at once: a vertex, x y z 0, in a register.
//
// GCC's and Clang's vector types, in which + - * / and products with a double act on every lane:
// one AVX register where there is AVX, several smaller ones elsewhere. For the loops over springs,
// rings, triangles and particles; Eigen 3.4 cannot permute the lanes of four doubles, which cross
// products and turning rows into columns need.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "sim/mesh/triangle_mesh.h"
#include "sim/mesh/vertex_array.h"

// Without AVX, GCC remarks that code compiled with it would pass a Vec4d in another way. All files
// here are compiled for the same processor.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace pneuma::sim {

typedef double Vec4d __attribute__((vector_size(32)));

inline Vec4d load_vec4d(const double* from) {
  Vec4d row;
  std::memcpy(&row, from, sizeof row);
  return row;
}

inline void store_vec4d(Vec4d row, double* to) { std::memcpy(to, &row, sizeof row); }

/// The vertices of an array, read in a loop: a pointer and no more, which stays in a register.
class VertexReader {
 public:
  explicit VertexReader(const VertexArray& values) : first_(values.rows().data()) {}
  Vec4d operator[](int i) const { return load_vec4d(first_ + 4 * static_cast<std::ptrdiff_t>(i)); }

 private:
  const double* first_;
};

/// The same to be written.
class VertexWriter {
 public:
  explicit VertexWriter(VertexArray& values) : first_(values.rows().data()) {}
  void put(int i, Vec4d row) const {
    store_vec4d(row, first_ + 4 * static_cast<std::ptrdiff_t>(i));
  }

 private:
  double* first_;
};

/// x y z 0 as y z x 0.
inline Vec4d yzx(Vec4d row) { return __builtin_shufflevector(row, row, 1, 2, 0, 3); }

/// a b + c, rounded once. -ffp-contract=off forbids the compiler to choose that by itself, as its
/// choice, and so the bits of a result, would change with what is inlined where.
inline double fma(double a, double b, double c) { return std::fma(a, b, c); }
inline Vec4d fma(Vec4d a, Vec4d b, Vec4d c) {
#ifdef __FMA__
  return Vec4d(_mm256_fmadd_pd(__m256d(a), __m256d(b), __m256d(c)));
#else
  return Vec4d{std::fma(a[0], b[0], c[0]), std::fma(a[1], b[1], c[1]), std::fma(a[2], b[2], c[2]),
               std::fma(a[3], b[3], c[3])};
#endif
}
inline Vec4d fma(double a, Vec4d b, Vec4d c) { return fma(Vec4d{a, a, a, a}, b, c); }

/// c - a b, rounded once. GCC does not make one instruction of fma(-a, b, c).
inline Vec4d fnma(double a, Vec4d b, Vec4d c) {
#ifdef __FMA__
  return Vec4d(_mm256_fnmadd_pd(__m256d(Vec4d{a, a, a, a}), __m256d(b), __m256d(c)));
#else
  return fma(-a, b, c);
#endif
}

inline Vec4d square_root(Vec4d row) {
  Eigen::Array4d lanes;
  store_vec4d(row, lanes.data());
  lanes = lanes.sqrt();
  return load_vec4d(lanes.data());
}

inline Vec4d min(Vec4d a, Vec4d b) { return a < b ? a : b; }
inline Vec4d max(Vec4d a, Vec4d b) { return a > b ? a : b; }

/// Of what a comparison returns.
template <class Comparison>
bool all_of_lanes(Comparison lanes) {
#ifdef __AVX__
  return _mm256_movemask_pd(__m256d(lanes)) == 0b1111;
#else
  return lanes[0] && lanes[1] && lanes[2] && lanes[3];
#endif
}

inline double sum_of_lanes(Vec4d row) { return row[0] + row[1] + row[2] + row[3]; }
inline double greatest_lane(Vec4d lanes) {
  return std::max(std::max(lanes[0], lanes[1]), std::max(lanes[2], lanes[3]));
}
inline double smallest_lane(Vec4d lanes) { return -greatest_lane(-lanes); }

inline Vec4d to_vec4d(const Vec3& v) { return Vec4d{v.x(), v.y(), v.z(), 0.0}; }
inline Vec3 to_vec3(Vec4d row) { return {row[0], row[1], row[2]}; }

/// Of rows x y z 0.
inline Vec4d cross(Vec4d a, Vec4d b) { return yzx(fma(a, yzx(b), -(yzx(a) * b))); }
inline double dot(Vec4d a, Vec4d b) {
  const Vec4d products = a * b;
  return products[0] + products[1] + products[2];
}

/// The coordinates of four vertices.
struct Vec3x4 {
  Vec4d x, y, z;
};

/// Of each of four vertices.
inline Vec4d dots(Vec4d direction, const Vec3x4& vertices) {
  return fma(direction[0], vertices.x, fma(direction[1], vertices.y, direction[2] * vertices.z));
}

inline Vec3x4 to_columns(Vec4d a, Vec4d b, Vec4d c, Vec4d d) {
  const Vec4d xz_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Vec4d xz_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Vec4d yw_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Vec4d yw_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return {__builtin_shufflevector(xz_ab, xz_cd, 0, 1, 4, 5),
          __builtin_shufflevector(yw_ab, yw_cd, 0, 1, 4, 5),
          __builtin_shufflevector(xz_ab, xz_cd, 2, 3, 6, 7)};
}

inline std::array<Vec4d, 4> to_rows(const Vec3x4& v) {
  const Vec4d zero{};
  const Vec4d xy_02 = __builtin_shufflevector(v.x, v.y, 0, 4, 2, 6);
  const Vec4d xy_13 = __builtin_shufflevector(v.x, v.y, 1, 5, 3, 7);
  const Vec4d z0_02 = __builtin_shufflevector(v.z, zero, 0, 4, 2, 6);
  const Vec4d z0_13 = __builtin_shufflevector(v.z, zero, 1, 5, 3, 7);
  return {__builtin_shufflevector(xy_02, z0_02, 0, 1, 4, 5),
          __builtin_shufflevector(xy_13, z0_13, 0, 1, 4, 5),
          __builtin_shufflevector(xy_02, z0_02, 2, 3, 6, 7),
          __builtin_shufflevector(xy_13, z0_13, 2, 3, 6, 7)};
}

/// A 3 x 3 matrix by its columns, each x y z 0.
struct Mat3x4 {
  std::array<Vec4d, 3> columns;

  Vec4d operator*(Vec4d v) const {
    return fma(v[0], columns[0], fma(v[1], columns[1], v[2] * columns[2]));
  }
};

inline Mat3x4 mat3x4(const Mat3& matrix) {
  return {{to_vec4d(matrix.col(0)), to_vec4d(matrix.col(1)), to_vec4d(matrix.col(2))}};
}

inline Mat3 to_mat3(const Mat3x4& m) {
  Mat3 matrix;
  matrix << to_vec3(m.columns[0]), to_vec3(m.columns[1]), to_vec3(m.columns[2]);
  return matrix;
}

inline Mat3x4 transposed(const Mat3x4& m) {
  const Vec3x4 rows = to_columns(m.columns[0], m.columns[1], m.columns[2], Vec4d{});
  return {{rows.x, rows.y, rows.z}};
}

}  // namespace pneuma::sim

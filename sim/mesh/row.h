// Four doubles that are added and multiplied at once: a vertex, x y z 0, in a register.
//
// GCC's and Clang's vector types, in which + - * / and products with a double act on every lane:
// one AVX register where there is AVX, several smaller ones elsewhere. For the loops over springs,
// rings, triangles and particles; Eigen 3.4 cannot permute the lanes of four doubles, which cross
// products and turning rows into columns need.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstring>

#include "sim/mesh/triangle_mesh.h"
#include "sim/mesh/vertex_array.h"

// Without AVX, GCC remarks that code compiled with it would pass a Row in another way. All files
// here are compiled for the same processor.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace pneuma::sim {

typedef double Row __attribute__((vector_size(32)));

inline Row load_row(const double* from) {
  Row row;
  std::memcpy(&row, from, sizeof row);
  return row;
}

inline void store_row(Row row, double* to) { std::memcpy(to, &row, sizeof row); }

/// The vertices of an array, read in a loop: a pointer and no more, which stays in a register.
class RowReader {
 public:
  explicit RowReader(const VertexArray& values) : first_(values.rows().data()) {}
  Row operator[](int i) const { return load_row(first_ + 4 * static_cast<std::ptrdiff_t>(i)); }

 private:
  const double* first_;
};

/// The same to be written.
class RowWriter {
 public:
  explicit RowWriter(VertexArray& values) : first_(values.rows().data()) {}
  void put(int i, Row row) const { store_row(row, first_ + 4 * static_cast<std::ptrdiff_t>(i)); }

 private:
  double* first_;
};

/// x y z 0 as y z x 0.
inline Row turned(Row row) { return __builtin_shufflevector(row, row, 1, 2, 0, 3); }

inline Row square_root(Row row) {
  Eigen::Array4d lanes;
  store_row(row, lanes.data());
  lanes = lanes.sqrt();
  return load_row(lanes.data());
}

inline Row lesser(Row a, Row b) { return a < b ? a : b; }
inline Row greater(Row a, Row b) { return a > b ? a : b; }

inline double sum_of_lanes(Row row) { return row[0] + row[1] + row[2] + row[3]; }

inline Row to_row(const Vec3& v) { return Row{v.x(), v.y(), v.z(), 0.0}; }
inline Vec3 to_vec3(Row row) { return {row[0], row[1], row[2]}; }

/// Of rows x y z 0.
inline Row cross(Row a, Row b) { return turned(a * turned(b) - turned(a) * b); }
inline double dot(Row a, Row b) {
  const Row products = a * b;
  return products[0] + products[1] + products[2];
}

/// The coordinates of four vertices.
struct Columns {
  Row x, y, z;
};

inline Columns columns(Row a, Row b, Row c, Row d) {
  const Row xz_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Row xz_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Row yw_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Row yw_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return {__builtin_shufflevector(xz_ab, xz_cd, 0, 1, 4, 5),
          __builtin_shufflevector(yw_ab, yw_cd, 0, 1, 4, 5),
          __builtin_shufflevector(xz_ab, xz_cd, 2, 3, 6, 7)};
}

/// A 3 x 3 matrix by its columns, each x y z 0.
struct RowMatrix {
  std::array<Row, 3> columns;

  Row operator*(Row v) const { return columns[0] * v[0] + (columns[1] * v[1] + columns[2] * v[2]); }
};

inline RowMatrix row_matrix(const Mat3& matrix) {
  return {{to_row(matrix.col(0)), to_row(matrix.col(1)), to_row(matrix.col(2))}};
}

inline RowMatrix transposed(const RowMatrix& m) {
  const Columns rows = columns(m.columns[0], m.columns[1], m.columns[2], Row{});
  return {{rows.x, rows.y, rows.z}};
}

}  // namespace pneuma::sim

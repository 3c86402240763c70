// The memory layout of everything that is stored per vertex: positions, velocities, forces.
//
// Four doubles a vertex, x y z 0, so that one vertex is one 32-byte AVX register and a gather of a
// neighbour is a single aligned load. Only this file knows the layout.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace pneuma::sim {

/// Of a vertex: where its row begins, in doubles. Loops that wait for loads read it ready-made.
using RowStart = std::uint32_t;

inline RowStart row_start(int vertex) { return 4u * static_cast<RowStart>(vertex); }

class VertexArray {
 public:
  using Rows = Eigen::Matrix<double, 4, Eigen::Dynamic>;

  VertexArray() = default;
  explicit VertexArray(int count) : rows_(Rows::Zero(4, count)) {}

  int size() const { return static_cast<int>(rows_.cols()); }

  /// Vertex i as a three-vector that can be read and assigned.
  auto operator[](int i) { return rows_.col(i).head<3>(); }
  auto operator[](int i) const { return rows_.col(i).head<3>(); }

  /// All vertices as one 4 x size matrix whose last row is zero: for sums over whole arrays.
  Rows& rows() { return rows_; }
  const Rows& rows() const { return rows_; }

 private:
  Rows rows_;
};

/// The greatest distance of a vertex in one from that in the other.
inline double max_distance(const VertexArray& one, const VertexArray& other) {
  return std::sqrt((one.rows() - other.rows()).colwise().squaredNorm().maxCoeff());
}

}  // namespace pneuma::sim

// The six coordinates of a free box among the vertices of all surfaces.
//
// A box moves by dp and turns by dtheta about its centre, so that its corner i moves by
// dx_i = dp + dtheta x r_i. Arrays over vertices in which boxes have their six coordinates carry dp
// in the place of a box's first corner and dtheta in that of its second, and zero in the others':
// `expand` makes ways of corners of them, and `contract`, its transpose, force and torque of the
// forces on corners.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sim/mesh/vertex_array.h"
#include "sim/potential/pair_distance.h"

namespace pneuma::sim {

using Mat3x6 = Eigen::Matrix<double, 3, 6>;

inline constexpr int box_corners = 8;

/// Where the corners of a box are.
struct BoxFrame {
  int first_vertex = 0;
  std::array<Vec3, box_corners> arms{};  // r_i, m

  bool has(int vertex) const {
    return vertex >= first_vertex && vertex < first_vertex + box_corners;
  }
  /// How a corner moves with the six coordinates.
  Mat3x6 rates(int vertex) const;
};

void expand(const std::vector<BoxFrame>& frames, VertexArray& values);
void contract(const BoxFrame& frame, VertexArray& values);

/// Of a box in an array that is contracted: dp and dtheta, or force and torque.
Vec6 six_of(const BoxFrame& frame, const VertexArray& values);
void set_six(const BoxFrame& frame, const Vec6& six, VertexArray& values);

}  // namespace pneuma::sim

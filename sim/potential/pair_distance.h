// The distance of a vertex and a triangle, or of two edges, with its first and second derivatives.
//
// The nearest points of a pair are r = sum of c_i x_i apart, with weights c of its four vertices
// that sum to 0. As the squared distance is a minimum over the places on both features, its
// gradient is that at fixed weights, and its second derivative that at fixed weights less what the
// nearest points gain by sliding (a Schur complement): with c(theta) along theta, e = dr/dtheta,
//
//   d^2 |r|^2 / dx dx = 2 [c c^T (x) I - M (e . e)^-1 M^T],   M = c (x) e + dc/dtheta (x) r.
#pragma once

#include <Eigen/Core>
#include <array>

#include "sim/mesh/triangle_mesh.h"

namespace pneuma::sim {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Vec12 = Eigen::Matrix<double, 12, 1>;
using Mat12 = Eigen::Matrix<double, 12, 12>;

/// Vertex and triangle: the vertex, then the triangle's. Two edges: one's ends, then the other's.
using PairCorners = std::array<Vec3, 4>;
using PairWeights = std::array<double, 4>;

/// Where a pair is nearest. How many places slide says which region of the pair it is: none of two
/// vertices, one of a vertex and an edge, two where both features are met inside.
struct PairPoint {
  PairWeights weights{};               // c; above 0 on the first feature, below on the second
  Vec3 apart = Vec3::Zero();           // r, from the second to the first, m
  double distance = 0.0;               // m
  int slides = 0;                      // number of theta
  std::array<PairWeights, 2> rates{};  // dc/dtheta

  Vec3 normal() const { return apart / distance; }
};

PairPoint nearest_vertex_triangle(const PairCorners& x);
/// Of edges that are parallel to rounding one of their ends is nearest.
PairPoint nearest_edge_edge(const PairCorners& x);

/// Of a distance above 0.
Vec12 distance_gradient(const PairPoint& point);
Mat12 distance_hessian(const PairCorners& x, const PairPoint& point);

/// The nearest symmetric matrix without negative eigenvalues.
Mat12 positive_part(const Mat12& matrix);

}  // namespace pneuma::sim

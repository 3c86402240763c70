#include "sim/potential/pair_distance.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace pneuma::sim {
namespace {

/// Of the squared sine between edges: below, where they are nearest is lost in rounding.
constexpr double parallel = 1e-14;

/// Fills in what follows from the weights.
PairPoint finished(const PairCorners& x, PairPoint point) {
  for (std::size_t i = 0; i < 4; ++i) point.apart += point.weights[i] * x[i];
  point.distance = point.apart.norm();
  return point;
}

/// Of a vertex (weight `sign`) and the segment between two others.
PairPoint nearest_on_segment(const PairCorners& x, std::size_t vertex, std::size_t from,
                             std::size_t to, double sign) {
  const Vec3 along = x[to] - x[from];
  const double squared = along.squaredNorm();
  const double place =
      squared > 0.0 ? std::clamp((x[vertex] - x[from]).dot(along) / squared, 0.0, 1.0) : 0.0;
  PairPoint point;
  point.weights[vertex] = sign;
  point.weights[from] = -sign * (1.0 - place);
  point.weights[to] = -sign * place;
  if (place > 0.0 && place < 1.0) {
    point.slides = 1;
    point.rates[0][from] = sign;
    point.rates[0][to] = -sign;
  }
  return finished(x, point);
}

const PairPoint& nearer(const PairPoint& a, const PairPoint& b) {
  return b.distance < a.distance ? b : a;
}

}  // namespace

PairPoint nearest_vertex_triangle(const PairCorners& x) {
  const Vec3 u = x[2] - x[1], v = x[3] - x[1], w = x[0] - x[1];
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm();
  const double wu = w.dot(u), wv = w.dot(v);
  const double determinant = uu * vv - uv * uv;
  const double second = wu * vv - wv * uv, third = wv * uu - wu * uv;
  if (determinant > parallel * uu * vv && second > 0.0 && third > 0.0 &&
      second + third < determinant) {
    const double b = second / determinant, c = third / determinant;
    PairPoint point;
    point.weights = {1.0, b + c - 1.0, -b, -c};
    point.slides = 2;
    point.rates = {PairWeights{0.0, 1.0, -1.0, 0.0}, PairWeights{0.0, 1.0, 0.0, -1.0}};
    return finished(x, point);
  }
  return nearer(nearer(nearest_on_segment(x, 0, 1, 2, 1.0), nearest_on_segment(x, 0, 2, 3, 1.0)),
                nearest_on_segment(x, 0, 3, 1, 1.0));
}

PairPoint nearest_edge_edge(const PairCorners& x) {
  const Vec3 u = x[1] - x[0], v = x[3] - x[2], w = x[0] - x[2];
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm();
  const double uw = u.dot(w), vw = v.dot(w);
  const double determinant = uu * vv - uv * uv;
  const double one = uv * vw - vv * uw, other = uu * vw - uv * uw;
  if (determinant > parallel * uu * vv && one > 0.0 && one < determinant && other > 0.0 &&
      other < determinant) {
    const double s = one / determinant, t = other / determinant;
    PairPoint point;
    point.weights = {1.0 - s, s, t - 1.0, -t};
    point.slides = 2;
    point.rates = {PairWeights{-1.0, 1.0, 0.0, 0.0}, PairWeights{0.0, 0.0, 1.0, -1.0}};
    return finished(x, point);
  }
  return nearer(nearer(nearest_on_segment(x, 0, 2, 3, 1.0), nearest_on_segment(x, 1, 2, 3, 1.0)),
                nearer(nearest_on_segment(x, 2, 0, 1, -1.0), nearest_on_segment(x, 3, 0, 1, -1.0)));
}

Vec12 distance_gradient(const PairPoint& point) {
  const Vec3 normal = point.normal();
  Vec12 gradient;
  for (int i = 0; i < 4; ++i) gradient.segment<3>(3 * i) = point.weights[at(i)] * normal;
  return gradient;
}

Mat12 distance_hessian(const PairCorners& x, const PairPoint& point) {
  Eigen::Matrix<double, 12, 2> m = Eigen::Matrix<double, 12, 2>::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Identity();
  Eigen::Matrix<double, 3, 2> along = Eigen::Matrix<double, 3, 2>::Zero();
  for (int a = 0; a < point.slides; ++a) {
    const PairWeights& rate = point.rates[at(a)];
    for (std::size_t i = 0; i < 4; ++i) along.col(a) += rate[i] * x[i];
    for (int i = 0; i < 4; ++i) {
      m.block<3, 1>(3 * i, a) = point.weights[at(i)] * along.col(a) + rate[at(i)] * point.apart;
    }
  }
  if (point.slides > 0) squares = along.transpose() * along;
  if (point.slides == 1) squares(1, 1) = 1.0;
  Mat12 half;  // of the second derivative of the squared distance
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      half.block<3, 3>(3 * i, 3 * j) =
          point.weights[at(i)] * point.weights[at(j)] * Mat3::Identity();
    }
  }
  half -= m * squares.inverse() * m.transpose();
  const Vec12 gradient = distance_gradient(point);
  return (half - gradient * gradient.transpose()) / point.distance;
}

Mat12 positive_part(const Mat12& matrix) {
  const Eigen::SelfAdjointEigenSolver<Mat12> solver(matrix);
  const Vec12 kept = solver.eigenvalues().cwiseMax(0.0);
  return solver.eigenvectors() * kept.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace pneuma::sim

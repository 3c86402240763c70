#include "sim/potential/pair_distance.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace pneuma::sim {
namespace {

/// Of the squared sine between edges: below, where they are nearest is lost in rounding.
constexpr double parallel = 1e-14;

/// Fills in what follows from the weights.
void finish(const PairCorners& x, PairPoint& point) {
  for (std::size_t i = 0; i < 4; ++i) point.apart += point.weights[i] * x[i];
  point.distance = point.apart.norm();
}

/// Of a vertex (weight `sign`) and the segment between two others.
struct OnSegment {
  OnSegment(const PairCorners& x, std::size_t its_vertex, std::size_t begin, std::size_t end,
            double its_sign)
      : vertex(its_vertex), from(begin), to(end), sign(its_sign) {
    const Vec3 along = x[to] - x[from], offset = x[vertex] - x[from];
    const double squared = along.squaredNorm();
    place = squared > 0.0 ? std::clamp(offset.dot(along) / squared, 0.0, 1.0) : 0.0;
    squared_distance = (offset - place * along).squaredNorm();
  }

  std::size_t vertex, from, to;
  double sign;
  double place;             // fraction of the way
  double squared_distance;  // m^2
};

const OnSegment& nearer(const OnSegment& a, const OnSegment& b) {
  return b.squared_distance < a.squared_distance ? b : a;
}

PairPoint point_of(const PairCorners& x, const OnSegment& nearest) {
  PairPoint point;
  point.weights[nearest.vertex] = nearest.sign;
  point.weights[nearest.from] = -nearest.sign * (1.0 - nearest.place);
  point.weights[nearest.to] = -nearest.sign * nearest.place;
  if (nearest.place > 0.0 && nearest.place < 1.0) {
    point.slides = 1;
    point.rates[0][nearest.from] = nearest.sign;
    point.rates[0][nearest.to] = -nearest.sign;
  }
  finish(x, point);
  return point;
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
    finish(x, point);
    return point;
  }
  const OnSegment first(x, 0, 1, 2, 1.0), opposite(x, 0, 2, 3, 1.0), last(x, 0, 3, 1, 1.0);
  return point_of(x, nearer(nearer(first, opposite), last));
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
    finish(x, point);
    return point;
  }
  const OnSegment start(x, 0, 2, 3, 1.0), end(x, 1, 2, 3, 1.0);
  const OnSegment other_start(x, 2, 0, 1, -1.0), other_end(x, 3, 0, 1, -1.0);
  return point_of(x, nearer(nearer(start, end), nearer(other_start, other_end)));
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

#include "sim/potential/mollifier.h"

namespace pneuma::sim {

double squared_cross(const PairCorners& edges) {
  return (edges[1] - edges[0]).cross(edges[3] - edges[2]).squaredNorm();
}

double mollifier_value(double squared_cross, double threshold) {
  if (squared_cross >= threshold) return 1.0;
  const double q = squared_cross / threshold;
  return (2.0 - q) * q;
}

// c = |u|^2 |v|^2 - (u . v)^2 by u and v, which are differences of corners.
Mollifier mollifier(const PairCorners& edges, double threshold) {
  Mollifier result;
  const double c = squared_cross(edges);
  if (c >= threshold) return result;
  const Vec3 u = edges[1] - edges[0], v = edges[3] - edges[2];
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm();
  Vec6 slope;
  slope.head<3>() = 2.0 * (vv * u - uv * v);
  slope.tail<3>() = 2.0 * (uu * v - uv * u);
  Mat6 curvature;
  curvature.topLeftCorner<3, 3>() = 2.0 * (vv * Mat3::Identity() - v * v.transpose());
  curvature.bottomRightCorner<3, 3>() = 2.0 * (uu * Mat3::Identity() - u * u.transpose());
  curvature.topRightCorner<3, 3>() =
      2.0 * (2.0 * u * v.transpose() - v * u.transpose() - uv * Mat3::Identity());
  curvature.bottomLeftCorner<3, 3>() = curvature.topRightCorner<3, 3>().transpose();

  const double q = c / threshold;
  const double first = (2.0 - 2.0 * q) / threshold, second = -2.0 / (threshold * threshold);
  result.value = (2.0 - q) * q;
  Eigen::Matrix<double, 6, 12> to_edges = Eigen::Matrix<double, 6, 12>::Zero();
  to_edges.block<3, 3>(0, 0) = -Mat3::Identity();
  to_edges.block<3, 3>(0, 3) = Mat3::Identity();
  to_edges.block<3, 3>(3, 6) = -Mat3::Identity();
  to_edges.block<3, 3>(3, 9) = Mat3::Identity();
  result.gradient = first * (to_edges.transpose() * slope);
  const Mat6 whole = first * curvature + second * slope * slope.transpose();
  result.hessian = to_edges.transpose() * whole * to_edges;
  return result;
}

}  // namespace pneuma::sim

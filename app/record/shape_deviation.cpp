#include "app/record/shape_deviation.h"

#include <Eigen/SVD>
#include <algorithm>

#include "sim/mesh/measure.h"

namespace pneuma::app {
namespace {

using sim::Mat3;
using sim::Vec3;

/// From the rest shape about its centre to the body about its own.
Mat3 best_rotation(const sim::VertexArray& rest, const Vec3& rest_centre,
                   const sim::VertexArray& body, const Vec3& centre) {
  Mat3 covariance = Mat3::Zero();
  for (int v = 0; v < body.size(); ++v) {
    covariance += (body[v] - centre) * (rest[v] - rest_centre).transpose();
  }
  const Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 signs = Vec3::Ones();
  signs.z() = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

double shape_deviation(const sim::SoftBody& body) {
  const sim::VertexArray& rest = body.mesh->rest_positions;
  const Vec3 rest_centre = sim::mean(rest), centre = sim::mean(body.positions);
  const Mat3 rotation = best_rotation(rest, rest_centre, body.positions, centre);
  double max_distance = 0.0;
  for (int v = 0; v < rest.size(); ++v) {
    const Vec3 laid = centre + rotation * (rest[v] - rest_centre);
    max_distance = std::max(max_distance, (body.positions[v] - laid).norm());
  }
  return max_distance / sim::bounds(rest).size().norm();
}

}  // namespace pneuma::app

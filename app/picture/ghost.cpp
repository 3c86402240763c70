#include "app/picture/ghost.h"

#include <Eigen/SVD>

#include "sim/mesh/measure.h"

namespace pneuma::app {

using sim::Vec3;

Eigen::Isometry3d pose_of(const sim::SoftBody& body) {
  const sim::VertexArray& rest = body.mesh->rest_positions;
  const Vec3 rest_centre = sim::mean(rest);
  const Vec3 centre = sim::mean(body.positions);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int v = 0; v < rest.size(); ++v) {
    covariance += Vec3(body.positions[v] - centre) * Vec3(rest[v] - rest_centre).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity();
  mirror(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = svd.matrixU() * mirror * svd.matrixV().transpose();
  pose.translation() = centre - pose.linear() * rest_centre;
  return pose;
}

void add_ghosts(const sim::World& world, render::Frame& frame) {
  const render::Colour ink = {1.0f, 1.0f, 1.0f};
  for (std::uint32_t i = 0; i < world.soft.size(); ++i) {
    const sim::SoftBody& body = world.soft[i];
    const Eigen::Isometry3d pose = pose_of(body);
    std::vector<render::Vec3f> places;
    for (int v = 0; v < body.mesh->rest_positions.size(); ++v) {
      places.emplace_back((pose * Vec3(body.mesh->rest_positions[v])).cast<float>());
    }
    for (const auto& [a, b] : body.mesh->topology.edges()) {
      frame.lines.push_back({places[sim::at(a)], places[sim::at(b)], ink, 1.0f, true, i});
    }
  }
}

}  // namespace pneuma::app

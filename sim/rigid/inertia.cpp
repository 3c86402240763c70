#include "sim/rigid/inertia.h"

namespace pneuma::sim {

Vec3 body_inertia(const RigidBox& box) {
  const Vec3 squares = box.size.cwiseAbs2();
  return box.mass / 12.0 * (Vec3::Constant(squares.sum()) - squares);
}

Mat3 world_inertia(const RigidBox& box) {
  const Mat3 rotation = box.orientation.toRotationMatrix();
  return rotation * body_inertia(box).asDiagonal() * rotation.transpose();
}

Mat3 world_inverse_inertia(const RigidBox& box, const Eigen::Quaterniond& orientation) {
  const Mat3 rotation = orientation.toRotationMatrix();
  return rotation * body_inertia(box).cwiseInverse().asDiagonal() * rotation.transpose();
}

Mat3 world_inverse_inertia(const RigidBox& box) {
  return world_inverse_inertia(box, box.orientation);
}

Vec3 spin(const RigidBox& box) {
  const Vec3 body_rate = box.orientation.conjugate() * box.angular_velocity;
  return box.orientation * body_inertia(box).cwiseProduct(body_rate);
}

}  // namespace pneuma::sim

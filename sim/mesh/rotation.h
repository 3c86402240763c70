// Rotations as people write them, and the cross product as a matrix.
#pragma once

#include <Eigen/Geometry>
#include <numbers>

#include "sim/mesh/triangle_mesh.h"

namespace pneuma::sim {

/// By so many degrees about the fixed axes x, then y, then z.
inline Eigen::Quaterniond rotation_of_degrees(const Vec3& degrees) {
  const Vec3 angles = degrees * (std::numbers::pi / 180.0);
  return Eigen::Quaterniond(Eigen::AngleAxisd(angles.z(), Vec3::UnitZ()) *
                            Eigen::AngleAxisd(angles.y(), Vec3::UnitY()) *
                            Eigen::AngleAxisd(angles.x(), Vec3::UnitX()));
}

/// m with m u = w x u.
inline Mat3 cross_matrix(const Vec3& w) {
  Mat3 m;
  m << 0.0, -w.z(), w.y(), w.z(), 0.0, -w.x(), -w.y(), w.x(), 0.0;
  return m;
}

}  // namespace pneuma::sim

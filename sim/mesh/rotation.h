// Rotations as people write them.
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

}  // namespace pneuma::sim

// A motion that is given by keys in time, as plain data.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "sim/mesh/triangle_mesh.h"

namespace pneuma::sim {

/// A time in s, then what is reached by it along x, y, z.
using KeyFrame = std::array<double, 4>;

/// Where a box is, whatever it meets: from where it starts, moved and turned by these, and at rest
/// before the first and after the last.
struct KeyFrames {
  std::vector<KeyFrame> path;      // m
  std::vector<KeyFrame> rotation;  // degrees about world x, then y, then z
  bool smooth = true;  // a cubic without overshoot and without jumps of speed, or even speeds

  bool empty() const { return path.empty() && rotation.empty(); }
  bool operator==(const KeyFrames&) const = default;
};

/// The same of one box, or of the vertices of a soft body that follow it.
struct GivenMotion {
  KeyFrames keys;
  Vec3 position = Vec3::Zero();                                     // m, what they start from
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // likewise
  Vec3 velocity = Vec3::Zero();                                     // m/s, on top of the keys
  Vec3 angular_velocity = Vec3::Zero();                             // rad/s, world axes, likewise
};

}  // namespace pneuma::sim

// A rigid box as plain data (section 4).
// Units: metre, kilogram, second, kelvin, mole.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <string>

#include "sim/mesh/triangle_mesh.h"
#include "sim/world/contact_material.h"
#include "sim/world/key_frames.h"

namespace pneuma::sim {

/// A box of uniform density (section 4).
struct RigidBox {
  std::string name;
  Vec3 size = Vec3::Ones();  // full lengths along body x, y, z: the paper's width, height, depth, m
  double mass = 1.0;         // kg
  bool is_kinematic = false;  // it keeps its velocities, whatever acts on it: its mass is unused
  std::shared_ptr<const GivenMotion> motion;  // of a kinematic box, if its velocities follow keys
  double rho_g =
      0.01;  // fraction of both velocities lost per 1/60 s, 0 <= rho_g < 1 (ERRATA row 35)
  ContactMaterial surface;
  Vec3 position = Vec3::Zero();                                     // centre of mass, m
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // body to world
  Vec3 velocity = Vec3::Zero();                                     // m/s
  Vec3 angular_velocity = Vec3::Zero();                             // rad/s, world axes
};

}  // namespace pneuma::sim

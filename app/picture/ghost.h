// Rest shapes of soft bodies, as lines where the bodies are.
#pragma once

#include <Eigen/Geometry>

#include "render/frame/frame.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// The rotation and the shift that bring a body's rest shape nearest to where its vertices are, by
/// the sum of squares (Kabsch 1976; Umeyama 1991, eq. 40 without a scale).
Eigen::Isometry3d pose_of(const sim::SoftBody& body);

/// Each is seen also through its body, but not through others that stand before it. The frame's
/// first meshes are the soft bodies.
void add_ghosts(const sim::World& world, render::Frame& frame);

}  // namespace pneuma::app

// How the camera of a run moves: it follows a body, goes around its target, or along a path.
#pragma once

#include <string>

#include "render/frame/frame.h"
#include "scenes/loader/scene.h"
#include "sim/mesh/measure.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// `camera` turned about the vertical through its target; from above anticlockwise, in degrees.
render::Camera turned(const render::Camera& camera, double degrees);

/// The camera of a path at a time: through all keys along cubic curves (Catmull-Rom, with the
/// keys' own times), from rest to rest. At least one key.
render::Camera camera_on_path(const scenes::CameraScene& scene, double time);

/// Around the body of that name, or all its copies. Empty if there is none.
sim::Bounds bounds_of_body(const sim::World& world, const std::string& name);

/// A function of the state alone, so that a run that is resumed sees the same.
class CameraMotion {
 public:
  /// `start`: the scene's world at its start.
  CameraMotion(const scenes::Scene& scene, const sim::World& start);

  /// `at_rest`: the camera without this motion.
  render::Camera at(const render::Camera& at_rest, const sim::World& world) const;

 private:
  scenes::CameraScene scene_;
  sim::Vec3 followed_from_ = sim::Vec3::Zero();  // centre of the body that is followed
};

}  // namespace pneuma::app

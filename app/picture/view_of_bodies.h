// The nearest view of all that bodies come to in a run.
#pragma once

#include <optional>
#include <string>

#include "render/frame/camera.h"
#include "scenes/loader/scene.h"
#include "sim/mesh/measure.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// From the direction that the scene gives, with the caption's place left free.
/// `world`: what the camera may have to look over; `from_all_around`: as it goes around.
render::ViewFit make_fit(const scenes::Scene& scene, const sim::World& world,
                         const sim::Vec3& origin, bool from_all_around);

/// Where a body is worth showing: one that falls or flies away for ever would make all others
/// vanish. `largest_body` is the max. diagonal of a single body, m.
sim::Bounds worth_showing(const sim::Bounds& start, double largest_body);

/// All that is to be seen of a run up to some frame; of an obstacle what is above the ground, if
/// that is drawn. It only grows, by what each state adds alone, so that a run that is continued
/// comes to the same.
class ViewOfBodies {
 public:
  /// `start`: the scene's world at its start.
  ViewOfBodies(const scenes::Scene& scene, const sim::World& start);

  /// Returns the first body that goes beyond what is worth showing, if any: of such a one that much
  /// counts.
  std::optional<std::string> add(const sim::World& world);

  render::ViewFit::Seen seen() const { return fit_.seen(); }
  void include(const render::ViewFit::Seen& seen) { fit_.include(seen); }

  /// The nearest from which all is in view; where the scene's camera goes around, from all sides,
  /// and its target lies on the vertical through the middle of the start.
  render::Camera camera() const;

 private:
  void add_point(const sim::Vec3& point);

  bool draws_ground_;
  sim::Bounds start_;
  bool turns_;
  render::ViewFit fit_;
};

/// The nearest camera that has all bodies in view as they are, from every side that `turned`
/// (camera_motion.h) brings it to.
render::Camera camera_around(const scenes::Scene& scene, const sim::World& world);

}  // namespace pneuma::app

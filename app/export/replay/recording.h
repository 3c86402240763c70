// A run as the replay page shows it: what the renderer would draw, and numbers to plot.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/picture/build_frame.h"
#include "app/picture/run_camera.h"
#include "app/world/simulation.h"
#include "render/frame/frame.h"
#include "scenes/loader/scene.h"
#include "sim/inspect/inspect.h"

namespace pneuma::app {

struct RecordedFrame {
  render::Camera camera;
  std::vector<render::Vec3f> positions;  // m, of the vertices of all meshes, one after the other
  std::vector<float> shares;  // of its bulge, 0..1, at each vertex of the meshes drawn rounded
  std::vector<render::Point> particles;  // as `--show particles` draws them
  std::vector<render::Point> contacts;   // as `--show contacts` does
  std::vector<render::Line> normals;     // of the contacts
  sim::Energy energy;
  double volume = 0.0;       // m^3, of all soft bodies
  double penetration = 0.0;  // m
};

struct Recording {
  std::string name;
  std::string title;
  std::int64_t first_frame = 0;
  int frames_per_second = 0;
  int steps_per_frame = 0;
  float aspect = 1.0f;  // width over height of the scene's pictures
  /// The first frame as the renderer is handed it, for all that stays the same: light, ground,
  /// shapes of the meshes.
  render::Frame first;
  std::vector<RecordedFrame> frames;
};

class Recorder {
 public:
  /// `start`: the scene's world at its start.
  Recorder(const scenes::Scene& scene, const sim::World& start, int threads = 1,
           CameraEvents events = {});

  /// A frame that is not recorded, before those that are.
  void pass(const Simulation& simulation) { camera_.see(simulation.world()); }
  void add(const Simulation& simulation);
  /// See RunCamera::take_frame.
  std::optional<SimulatedFrame> take_simulated(std::int64_t frame) {
    return camera_.take_frame(frame);
  }
  const Recording& recording() const { return recording_; }

 private:
  FrameBuilder builder_;
  RunCamera camera_;
  Recording recording_;
};

}  // namespace pneuma::app

// A scene's world for a program that steps it, reads it and draws it as it likes: what the Python
// module wraps.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/picture/build_frame.h"
#include "app/picture/run_camera.h"
#include "app/python/drawing_thread.h"
#include "app/world/simulation.h"
#include "scenes/loader/scene.h"

namespace pneuma::app {

/// Pixels of a picture; what is not given is the scene's.
struct PictureSize {
  std::optional<int> width;   // 16..16384
  std::optional<int> height;  // 16..16384
};

class ScriptedWorld {
 public:
  /// As `pneuma check SCENE --set ...` loads it, with the same errors; UsageError also for threads
  /// that --threads refuses.
  ScriptedWorld(const std::string& scene, const std::vector<std::string>& overrides, int threads);

  /// One step, in parts where `pneuma render` would take it so. Throws DivergenceError; the world
  /// is then in its last valid state.
  void step();

  /// The picture that `pneuma render` would make of this state, on any thread. For an
  /// automatic camera the scene is run ahead a little: see RunCamera. Throws
  /// UsageError for a size out of range, and render::GlError.
  render::Image draw(const PictureSize& size, Show show);

  const scenes::Scene& scene() const { return scene_; }
  const sim::World& world() const { return simulation_.world(); }
  std::span<const sim::Contact> contacts() const { return simulation_.contacts(); }
  /// What the program would warn of before a run.
  const std::vector<std::string>& warnings();

 private:
  scenes::Scene scene_;
  Simulation simulation_;
  RunCamera camera_;
  std::optional<FrameBuilder> builder_;
  std::optional<DrawingThread> drawing_;
  std::optional<std::vector<std::string>> warnings_;
};

}  // namespace pneuma::app

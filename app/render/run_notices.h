// What a run says beside its frames: steps that were done in parts, bodies that pass through each
// other, are pressed to next to nothing or are not in the picture.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/render/log/run_record.h"
#include "app/terminal/progress.h"
#include "app/world/simulation.h"
#include "render/frame/frame.h"

namespace pneuma::app {

/// Says that steps which diverged were done in parts: at the first of them, and in the end.
class DividedSteps {
 public:
  void add(const Simulation& simulation, Progress& progress);
  void summarise(Progress& progress) const;

 private:
  std::int64_t count_ = 0;
  int most_ = 0;
};

/// Says that bodies pass through each other, at the first frame that shows it and in the end; and
/// in the end that one passes through itself.
class CrossedFrames {
 public:
  void add(const Simulation& simulation, const FrameState& state, Progress& progress);
  /// `is_resumed`: earlier frames of the run are not counted.
  void summarise(Progress& progress, bool is_resumed) const;
  std::int64_t count() const { return count_; }

 private:
  std::int64_t frames_ = 0;
  std::int64_t count_ = 0;
  std::int64_t of_themselves_ = 0;
  std::string itself_;  // the first body that did
  bool may_use_potential_ = false;
};

/// Says in the end which body that keeps its gas was pressed to less than a tenth of its shape's
/// volume.
class PressedBodies {
 public:
  void add(const sim::World& world);
  void summarise(Progress& progress) const;

 private:
  std::vector<double> shapes_;  // m^3, of the soft bodies; empty before the first frame
  double least_fraction_ = 1.0;
  double time_ = 0.0;  // s
  std::string body_;
};

/// Says in the end in how many frames no body that may move was in the picture, and in how many
/// the camera was inside of one.
class UnseenFrames {
 public:
  /// `aspect`: width over height of the picture.
  void add(const sim::World& world, const render::Camera& camera, double aspect);
  void summarise(Progress& progress) const;

 private:
  std::int64_t frames_ = 0;
  std::int64_t empty_ = 0;
  std::int64_t inside_ = 0;
  std::string body_;  // the first that the camera was inside of
};

}  // namespace pneuma::app

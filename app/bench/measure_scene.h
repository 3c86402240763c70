// Measures how fast one scene runs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/bench/measure_frames.h"
#include "app/picture/show.h"
#include "app/record/contact_tally.h"
#include "app/record/statistics.h"
#include "render/context/backend.h"
#include "scenes/loader/scene.h"
#include "sim/step/stepper.h"

namespace pneuma::app {

struct MeasureOptions {
  std::optional<std::int64_t> steps;  // measure exactly as many steps, and as many frames
  double seconds = 1.0;  // else: for so long the steps, and for so long again the frames
  // s of the scene's time before the measured part, at most half its run. By default that half, so
  // that bodies which are to be in contact have come together.
  std::optional<double> warm_up;
  bool pictures = true;  // without, no GL context is made
  Show show;             // in these; particles are then part of the steps, too
  std::optional<render::Backend> backend;
  int threads = 1;
};

/// Frames per second of the same scene by the paper's method, without drawing; where there is none,
/// why. Neither for a scene that asks for this method itself.
struct PaperMethodFps {
  std::optional<Spread> fps;
  std::string reason;
};

/// Times of one scene. Contacts are those of the very steps whose times are given.
struct SceneTimes {
  std::string name;
  std::string title;
  std::string figure;
  std::optional<double> paper_fps;
  std::int64_t bodies = 0;

  double measured_from = 0.0;  // s of the scene's time; the part is measured over and over
  double measured_to = 0.0;
  int steps_per_frame = 1;    // so many make 1/60 s
  std::int64_t steps = 0;     // measured
  int steps_per_reading = 1;  // of the clock: more than one when a step is too short for it
  Spread step_seconds;
  std::optional<FrameTimes> frames;
  PaperMethodFps paper_method;  // by measure_paper_method
  ContactTally contacts;
  sim::Plan plan;
  sim::StageTimes stage_shares = {};  // of the time in stages; they add up to 1
  double processor_share = 1.0;       // of the time in which the measuring thread really ran
};

/// Frames of the paper per second, without drawing.
Spread simulation_fps(const SceneTimes& times);

/// Throws DivergenceError, and render::GlError when pictures are asked for.
SceneTimes measure_scene(const scenes::Scene& scene, const MeasureOptions& options);

/// Never throws for what the paper's method cannot run.
PaperMethodFps measure_paper_method(const scenes::Scene& scene, const MeasureOptions& options);

/// Seconds: the min. difference between two readings of the clock that differ.
double clock_resolution();

}  // namespace pneuma::app

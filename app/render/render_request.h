// What `pneuma render` was asked to do.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/accuracy/accuracy.h"
#include "app/picture/build_frame.h"
#include "app/render/log/resume.h"
#include "app/render/reference_pictures.h"
#include "app/terminal/frame_range.h"
#include "app/terminal/grid_size.h"
#include "app/world/model_scene.h"
#include "app/world/simulation.h"
#include "render/context/backend.h"

namespace pneuma::app {

struct RenderRequest {
  std::string scene;                   // a path or a name
  std::string out;                     // folder; empty: out/NAME
  std::vector<std::string> overrides;  // "PATH=VALUE"
  std::optional<Accuracy> accuracy;
  ModelChoice model;
  FrameRange frames;
  Pictures pictures;
  ExistingRun existing = ExistingRun::refuse;
  OnDivergence on_divergence = OnDivergence::automatic;
  std::optional<GridSize> sheet;
  std::string video;  // file; empty: none
  int turntable = 0;  // pictures of the last frame alone, from all around; 0: those of the run
  ReferencePictures reference;
  std::optional<render::Backend> backend;
  int threads = 1;
  bool quiet = false;
  std::vector<std::string> command_line;
};

}  // namespace pneuma::app

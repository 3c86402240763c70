// What `pneuma render` was asked to do.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/build_frame.h"
#include "app/frame_range.h"
#include "app/simulation.h"

namespace pneuma::app {

struct GridSize {
  int columns = 0;
  int rows = 0;
};

/// What to do when the folder already holds a run.
enum class ExistingRun { refuse, overwrite, resume };

struct RenderRequest {
  std::string scene;                   // a path or a name
  std::string out;                     // folder; empty: out/NAME
  std::vector<std::string> overrides;  // "PATH=VALUE"
  FrameRange frames;
  Pictures pictures;
  ExistingRun existing = ExistingRun::refuse;
  OnDivergence on_divergence = OnDivergence::stop;
  std::optional<GridSize> sheet;
  std::string video;  // file; empty: none
  int threads = 1;
  bool quiet = false;
  std::vector<std::string> command_line;
};

/// "4x3". Throws UsageError. Each from 1 to `greatest`; `option` is named in messages.
GridSize parse_grid(const std::string& option, const std::string& text, int greatest);

}  // namespace pneuma::app

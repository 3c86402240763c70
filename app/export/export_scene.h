// `pneuma export`: a run as files that other programs show.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/accuracy/accuracy.h"
#include "app/export/export_formats.h"
#include "app/host/exit_code.h"
#include "app/terminal/frame_range.h"
#include "app/world/model_scene.h"

namespace pneuma::app {

struct ExportRequest {
  std::string scene;  // a path or a name
  ExportFormat format = export_formats()[0];
  std::string out;                     // folder; empty: out/NAME
  std::vector<std::string> overrides;  // "PATH=VALUE"
  std::optional<Accuracy> accuracy;
  ModelChoice model;
  FrameRange frames;
  bool overwrite = false;
  int threads = 1;
  bool quiet = false;
};

/// Writes NAME_00042.ply and so on, or NAME.html, NAME.glb; no pictures, no GL. Throws
/// scenes::SceneError, UsageError, DivergenceError, Interrupted and base::IoError; what is on disk
/// then is whole, after a divergence or an interruption with all frames up to it.
ExitCode export_scene(const ExportRequest& request);

}  // namespace pneuma::app

// `pneuma export`: the bodies of each frame as mesh files.
#pragma once

#include <string>
#include <vector>

#include "app/export/mesh_formats.h"
#include "app/host/exit_code.h"
#include "app/terminal/frame_range.h"

namespace pneuma::app {

struct ExportRequest {
  std::string scene;  // a path or a name
  MeshFormat format = mesh_formats[0];
  std::string out;                     // folder; empty: out/NAME
  std::vector<std::string> overrides;  // "PATH=VALUE"
  FrameRange frames;
  bool overwrite = false;
  int threads = 1;
  bool quiet = false;
};

/// Writes NAME_00042.ply and so on; no pictures, no GL. Throws scenes::SceneError, UsageError,
/// DivergenceError, Interrupted and base::IoError; what is on disk then is whole.
ExitCode export_scene(const ExportRequest& request);

}  // namespace pneuma::app

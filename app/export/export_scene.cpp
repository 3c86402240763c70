#include "app/export/export_scene.h"

#include <fmt/format.h>

#include <filesystem>
#include <regex>

#include "app/export/exported_mesh.h"
#include "app/host/clock.h"
#include "app/host/interrupt.h"
#include "app/host/version.h"
#include "app/render/log/run_folder.h"
#include "app/terminal/progress.h"
#include "app/world/build_world.h"
#include "app/world/find_scene.h"
#include "app/world/simulation.h"
#include "scenes/loader/load_scene.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

/// Mesh files of the same scene and format, which a new sequence would be mixed with.
std::vector<fs::path> old_sequence(const fs::path& folder, const std::string& scene,
                                   const MeshFormat& format) {
  const std::regex numbered(fmt::format(R"(_[0-9]{{5,}}\.{})", format.name));
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(scene) && std::regex_match(name.substr(scene.size()), numbered)) {
      files.push_back(entry.path());
    }
  }
  return files;
}

void make_room(const fs::path& folder, const std::string& scene, const ExportRequest& request) {
  const std::vector<fs::path> old = old_sequence(folder, scene, request.format);
  if (old.empty()) return;
  if (!request.overwrite) {
    throw base::IoError(fmt::format(
        "{} holds {} mesh files of {}; replace them with --overwrite, or choose another "
        "folder with --out",
        folder.string(), old.size(), scene));
  }
  for (const fs::path& file : old) fs::remove(file);
}

void write_frames(const scenes::Scene& scene, const Frames& frames, const fs::path& folder,
                  const ExportRequest& request) {
  Progress progress(progress_style(request.quiet));
  Simulation simulation(scene, build_world(scene), request.threads);
  const MeshExporter exporter(scene, simulation.world());
  const Clock::time_point start = Clock::now();
  ProgressState state;
  state.last = frames.last;
  for (;; simulation.advance_frame()) {
    throw_if_interrupted();
    state.frame = simulation.frame();
    state.time = state.simulated = sim::time(simulation.world());
    if (state.frame >= frames.first) {
      const std::string comment =
          fmt::format("{} t = {:.6g} s, pneuma {}", scene.name, state.time, version().program);
      const fs::path file =
          folder / fmt::format("{}_{:05}.{}", scene.name, state.frame, request.format.name);
      base::write_file_atomically(
          file.string(), request.format.encode(exporter.meshes(simulation.world()), comment));
      ++state.drawn;
    }
    state.elapsed = seconds_since(start);
    progress.show(progress_line(state));
    if (state.frame >= frames.last) break;
  }
  progress.say(summary_line(state));
}

}  // namespace

ExitCode export_scene(const ExportRequest& request) {
  const scenes::Scene scene = scenes::load_scene(find_scene(request.scene), request.overrides);
  const Frames frames = frames_of(scene, request.frames);
  const fs::path folder =
      request.out.empty() ? fs::path("out") / scene.name : fs::path(request.out);
  RunFolder(folder, scene.name).make();
  make_room(folder, scene.name, request);
  write_frames(scene, frames, folder, request);
  fmt::print("{}\n", folder.string());
  return ExitCode::done;
}

}  // namespace pneuma::app

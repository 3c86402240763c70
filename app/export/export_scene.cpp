#include "app/export/export_scene.h"

#include <fmt/format.h>

#include <filesystem>
#include <regex>
#include <utility>

#include "app/accuracy/choose_step.h"
#include "app/host/clock.h"
#include "app/host/errors.h"
#include "app/host/interrupt.h"
#include "app/host/standard_streams.h"
#include "app/render/log/run_folder.h"
#include "app/terminal/progress.h"
#include "app/terminal/table.h"
#include "app/world/open_scene.h"
#include "app/world/simulation.h"
#include "scenes/loader/load_scene.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

/// Files of the same scene and format, which new ones would be mixed with.
std::vector<fs::path> old_files(const fs::path& folder, const std::string& scene,
                                const ExportFormat& format) {
  const std::regex ending{std::string(format.files)};
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(scene) && std::regex_match(name.substr(scene.size()), ending)) {
      files.push_back(entry.path());
    }
  }
  return files;
}

void make_room(const fs::path& folder, const std::string& scene, const ExportRequest& request) {
  const std::vector<fs::path> old = old_files(folder, scene, request.format);
  if (old.empty()) return;
  if (!request.overwrite) {
    throw base::IoError(fmt::format(
        "{} holds {} {} file{} of {}; replace them with --overwrite, or choose another folder with "
        "--out",
        folder.string(), old.size(), request.format.name, old.size() == 1 ? "" : "s", scene));
  }
  if (request.format.written_last) return;  // over the old ones, which are there until then
  for (const fs::path& file : old) fs::remove(file);
}

void advance_frame(Simulation& simulation, FrameSink& sink) {
  if (auto frame = sink.take_simulated(simulation.frame() + 1)) {
    simulation.adopt(*std::move(frame));
  } else {
    simulation.advance_frame();
  }
}

/// Hands the wanted frames to the sink.
void run_frames(Simulation& simulation, const Frames& frames, FrameSink& sink, ProgressState& state,
                Progress& progress) {
  const Clock::time_point start = Clock::now();
  state.last = frames.last;
  for (;; advance_frame(simulation, sink)) {
    throw_if_interrupted();
    state.frame = simulation.frame();
    state.time = state.simulated = sim::time(simulation.world());
    if (state.frame >= frames.first) {
      sink.add(simulation);
      ++state.drawn;
    } else {
      sink.pass(simulation);
    }
    state.elapsed = seconds_since(start);
    progress.show(progress_line(state));
    if (state.frame >= frames.last) break;
  }
  progress.say(summary_line(state));
}

/// One who names a file of the format means it, and not a folder.
void check_folder(const fs::path& folder, const ExportFormat& format) {
  if (folder.extension() != fmt::format(".{}", format.name) || fs::is_directory(folder)) return;
  throw UsageError(fmt::format(
      "--out {}: this names a file, and --out takes the folder for files called as the scene; "
      "name a folder, such as {}",
      folder.string(), fs::path(folder).replace_extension().string()));
}

void print_path(const fs::path& path) { fmt::print("{}\n", path.string()); }

sim::World start_of(const scenes::Scene& scene) {
  const NothingToKeep nothing;
  return build_checked_world(scene);
}

void write_frames(const scenes::Scene& scene, const Frames& frames, const fs::path& folder,
                  const ExportRequest& request) {
  Progress progress(progress_style(request.quiet));
  sim::World start = start_of(scene);
  start.settings.particles.shown = request.format.shows_particles;
  const auto sink = request.format.open(
      {scene, start, frames.last - frames.first + 1, folder, request.threads, progress});
  make_room(folder, scene.name, request);
  Simulation simulation(scene, start, request.threads);
  ProgressState state;
  const auto keep_frames_so_far = [&] {
    if (state.drawn == 0) return;
    print_path(sink->finish());
    print_message("partial: {} of {}, up to t = {:.2f} s\n", state.drawn,
                  counted(frames.last - frames.first + 1, "frame"), state.time);
  };
  try {
    run_frames(simulation, frames, *sink, state, progress);
  } catch (const DivergenceError&) {
    keep_frames_so_far();
    throw;
  } catch (const Interrupted&) {
    keep_frames_so_far();
    throw;
  }
  print_path(sink->finish());
}

}  // namespace

ExitCode export_scene(const ExportRequest& request) {
  const auto [scene, choice] = with_nothing_to_keep([&] {
    return open_scene(request.scene, request.overrides, request.model, request.accuracy);
  });
  if (!choice.empty() && !request.quiet) print_message("{}\n", choice);
  const Frames frames = frames_of(scene, request.frames);
  const fs::path folder =
      request.out.empty() ? fs::path("out") / scene.name : fs::path(request.out);
  check_folder(folder, request.format);
  RunFolder(folder, scene.name).make();
  write_frames(scene, frames, folder, request);
  return ExitCode::done;
}

}  // namespace pneuma::app

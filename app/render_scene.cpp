#include "app/render_scene.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "app/build_world.h"
#include "app/command_line.h"
#include "app/contact_sheet.h"
#include "app/draw_frames.h"
#include "app/errors.h"
#include "app/find_program.h"
#include "app/find_scene.h"
#include "app/interrupt.h"
#include "app/place_camera.h"
#include "app/resume.h"
#include "app/run_command.h"
#include "app/run_record.h"
#include "app/step_advice.h"
#include "app/video.h"
#include "render/image/file.h"
#include "scenes/load_scene.h"
#include "scenes/print_scene.h"
#include "sim/step/plan.h"

namespace pneuma::app {
namespace {

RunFolder folder_of(const scenes::Scene& scene, const std::string& out) {
  return {out.empty() ? std::filesystem::path("out") / scene.name : std::filesystem::path(out),
          scene.name};
}

render::RenderOptions picture_options(const scenes::PictureScene& picture) {
  render::RenderOptions options;
  options.width = picture.width;
  options.height = picture.height;
  options.samples = picture.samples;
  return options;
}

render::Camera choose_camera(const scenes::Scene& scene, const sim::World& start, int threads,
                             Progress& progress) {
  const auto on_frame = [&](const sim::World& world) {
    throw_if_interrupted();
    progress.show(fmt::format("looking ahead for the camera: t = {:.2f} s of {:g} s",
                              sim::time(world), scene.duration));
  };
  const PlacedCamera placed = place_camera(scene, start, threads, on_frame);
  if (!placed.notice.empty()) progress.say(fmt::format("{}: {}", scene.name, placed.notice));
  return placed.camera;
}

/// The journal becomes run.json, and is the last thing to go: until then the run can be continued.
void close_run(const RunFolder& folder) {
  const auto journal = read_journal(folder.journal());
  const std::string text = whole_record(journal.value()).dump(1) + "\n";
  render::write_file_atomically(folder.record().string(),
                                {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  std::filesystem::remove(folder.journal());
  std::filesystem::remove(folder.state());
}

/// Particles are asked for in vain where no two soft bodies can meet.
void warn_of_missing_particles(const Pictures& pictures, const scenes::Scene& scene,
                               const sim::World& world, Progress& progress) {
  const bool asked = pictures.show.particles || (pictures.overlay && pictures.overlay->particles);
  const sim::Plan plan = sim::make_plan(world);
  if (!asked || plan.runs(sim::Stage::move_particles)) return;
  const auto stage = static_cast<std::size_t>(sim::Stage::move_particles);
  progress.say(fmt::format("{}: there are no collision particles to draw: {}", scene.name,
                           plan.stages[stage].reason));
}

/// The command that continues a run.
std::string resume_command(std::vector<std::string> command_line) {
  std::erase_if(command_line, [](const std::string& argument) {
    return argument == "--overwrite" || argument == "--resume";
  });
  command_line.emplace_back("--resume");
  return shell_line(command_line);
}

void make_frames(const RenderRequest& request, const scenes::Scene& scene, const Frames& frames,
                 const RunFolder& folder, Progress& progress) {
  const sim::World start = build_world(scene);
  for (const StepAdvice& advice : step_advices(start)) {
    if (advice.too_long()) {
      progress.say(fmt::format("{}: warning: {}", scene.name, step_warning(advice)));
    }
  }
  render::Renderer renderer(picture_options(scene.picture));
  warn_of_missing_particles(request.pictures, scene, start, progress);

  const Json identity =
      run_identity(scene, start, frames.first, frames.last, request, renderer.description());
  const OpenedFolder opened =
      open_folder(folder, request.existing, identity, scenes::print_scene(scene));
  if (opened.finished) return progress.say("the run is finished already");

  const auto& old = opened.unfinished;
  const Json header =
      old ? old->header
          : run_header(identity, scene, choose_camera(scene, start, request.threads, progress));
  const int steps_per_frame = scene.settings.steps_per_second / scene.picture.frames_per_second;
  const Continuation from =
      old ? find_continuation(folder, *old, identity, start, frames.first, steps_per_frame)
          : Continuation{frames.first, start, 0, ""};
  Journal journal(folder.journal(), from.journal_bytes);
  if (!old) journal.append(header);
  if (!from.change.empty()) {
    journal.append(change_line(identity, scene, from.next_frame, from.change));
  }
  journal.append(launch_line(request.command_line, request.threads, from.next_frame));

  Simulation simulation(scene, from.world, request.threads, request.on_divergence);
  const FrameBuilder builder(scene, from.world, camera_of(header));
  try {
    draw_frames(simulation, from.next_frame, frames.last,
                {builder, request.pictures, renderer, folder, journal}, progress);
  } catch (const DivergenceError& error) {
    journal.append(divergence_line(error.what()));
    throw DivergenceError(fmt::format(
        "{}\nThe frames so far are whole. To go on from the last of them, add what is to be done "
        "otherwise, a --set simulation.KEY=VALUE or --on-divergence substep, to: {}",
        error.what(), resume_command(request.command_line)));
  }
  close_run(folder);
}

/// Before the run, which may take long.
void check_video(const scenes::Scene& scene, const std::string& video, Progress& progress) {
  check_video_place(video);
  if (const auto ffmpeg = find_program("ffmpeg")) {
    try_video(*ffmpeg, scene.picture.width, scene.picture.height, video);
  } else {
    progress.say("ffmpeg is not installed; after the run, the command for the video is printed");
  }
}

void make_video(const RunFolder& folder, std::int64_t first, int frames_per_second,
                const std::string& video) {
  const auto command = video_command(folder, first, frames_per_second, video);
  if (const auto ffmpeg = find_program("ffmpeg")) {
    run_command(*ffmpeg, command);
    fmt::print("{}\n", video);
  } else {
    fmt::print(stderr,
               "ffmpeg is not installed (apt-get install ffmpeg). The command for {}:\n{}\n", video,
               shell_line(command));
  }
}

}  // namespace

ExitCode render_scene(const RenderRequest& request) {
  Progress progress(progress_style(request.quiet));
  const scenes::Scene scene = scenes::load_scene(find_scene(request.scene), request.overrides);
  const Frames frames = frames_of(scene, request.frames);
  const RunFolder folder = folder_of(scene, request.out);
  try {
    if (!request.video.empty()) check_video(scene, request.video, progress);
    make_frames(request, scene, frames, folder, progress);
    fmt::print("{}\n", folder.path().string());
    if (request.sheet) {
      write_contact_sheet(folder, frames.first, frames.last, *request.sheet);
      fmt::print("{}\n", folder.sheet().string());
    }
    if (!request.video.empty()) {
      make_video(folder, frames.first, scene.picture.frames_per_second, request.video);
    }
  } catch (const Interrupted&) {
    throw Interrupted("interrupted; continue with: " + resume_command(request.command_line));
  }
  return ExitCode::done;
}

}  // namespace pneuma::app

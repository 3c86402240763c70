#include "app/render/render_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "app/accuracy/choose_step.h"
#include "app/files/find_model.h"
#include "app/files/refuse_to_replace.h"
#include "app/host/command_line.h"
#include "app/host/errors.h"
#include "app/host/find_program.h"
#include "app/host/interrupt.h"
#include "app/host/run_command.h"
#include "app/host/standard_streams.h"
#include "app/picture/camera_events.h"
#include "app/picture/place_camera.h"
#include "app/render/animated_png.h"
#include "app/render/contact_sheet.h"
#include "app/render/draw_frames.h"
#include "app/render/log/past_launches.h"
#include "app/render/log/run_log.h"
#include "app/render/redraw.h"
#include "app/render/turntable.h"
#include "app/render/video.h"
#include "app/world/gas_warnings.h"
#include "app/world/may_start.h"
#include "app/world/open_scene.h"
#include "app/world/scene_warnings.h"
#include "assets/model_file.h"
#include "scenes/loader/print_scene.h"
#include "sim/base/file.h"
#include "sim/step/stages/plan.h"

namespace pneuma::app {
namespace {

RunFolder folder_of(const scenes::Scene& scene, const std::string& out) {
  return {out.empty() ? std::filesystem::path("out") / scene.name : std::filesystem::path(out),
          scene.name};
}

render::RenderOptions picture_options(const scenes::PictureScene& picture,
                                      std::optional<render::Backend> backend) {
  render::RenderOptions options;
  options.backend = backend;
  options.width = picture.width;
  options.height = picture.height;
  options.samples = picture.samples;
  return options;
}

bool shows_particles(const Pictures& pictures) {
  return pictures.show.particles || (pictures.overlay && pictures.overlay->particles);
}

/// Steps may be too long, gas may blow bodies up, and particles are asked for in vain where no two
/// soft bodies can meet.
void warn_before_run(const Pictures& pictures, const scenes::Scene& scene, const sim::World& world,
                     Progress& progress) {
  const std::vector<GasAdvice> gas = gas_advices_before_run(scene, world);
  for (const std::string& warning : scene_warnings(scene, world, step_advices(world), gas)) {
    progress.say(warning);
  }
  for (const GasAdvice& advice : gas) {
    if (!advice.left_out) continue;
    progress.say(fmt::format("{}: body '{}': {}; `pneuma check` tries", scene.name, advice.body,
                             volumes_text(advice)));
  }
  const sim::Plan plan = sim::make_plan(world);
  if (!shows_particles(pictures) || plan.runs(sim::Stage::move_particles)) return;
  const auto stage = static_cast<std::size_t>(sim::Stage::move_particles);
  progress.say(fmt::format("{}: there are no collision particles to draw: {}", scene.name,
                           plan.stages[stage].reason));
}

sim::World prepare_world(const RenderRequest& request, const scenes::Scene& scene,
                         Progress& progress) {
  const NothingToKeep nothing;
  sim::World start = build_checked_world(scene);
  start.settings.particles.shown = shows_particles(request.pictures);
  warn_before_run(request.pictures, scene, start, progress);
  return start;
}

/// The command that continues a run.
std::string resume_command(std::vector<std::string> command_line) {
  std::erase_if(command_line, [](const std::string& argument) {
    return argument == "--overwrite" || argument == "--resume";
  });
  command_line.emplace_back("--resume");
  return shell_line(command_line);
}

bool has_moved_bodies(const scenes::Scene& scene) {
  return std::ranges::any_of(scene.bodies, [](const scenes::BodyScene& body) {
    return body.kind == scenes::BodyKind::moved || !body.motion.empty();
  });
}

bool may_step_implicitly(const scenes::Scene& scene) {
  return !sim::is_implicit(scene.settings.integrator) &&
         std::ranges::any_of(scene.bodies, [](const scenes::BodyScene& body) {
           return body.kind == scenes::BodyKind::soft;
         });
}

/// What may help a run that diverged. Once shorter steps have failed, steps of another kind.
std::string other_steps(const scenes::Scene& scene, const DivergenceError& error) {
  if (error.tried_parts && may_step_implicitly(scene))
    return "--set simulation.integrator=implicit_euler";
  const int steps = std::max(2 * scene.settings.steps_per_second, error.steps_per_second);
  return fmt::format("--set simulation.steps_per_second={}{}", steps,
                     error.tried_parts ? "" : " or --on-divergence substep");
}

/// What may help where a run that goes on stays as it is: to begin again.
std::string other_beginning(const scenes::Scene& scene, const DivergenceError& error) {
  const bool is_short_of_room = error.is_crushed || error.has_no_room;
  if (is_short_of_room || has_moved_bodies(scene)) {
    return fmt::format(
        "{} motion.path or motion.rotation leave more room, and begin again with --overwrite",
        is_short_of_room ? "Let" : "Shorter steps do not help: let");
  }
  return fmt::format(
      "Shorter steps do not help from here: begin again with --overwrite and {}--set "
      "simulation.steps_per_second={}{}",
      may_step_implicitly(scene) ? "--set simulation.integrator=implicit_euler, or with " : "",
      4 * scene.settings.steps_per_second,
      may_use_potential(scene, "sdirk2") ? ", or with --set simulation.contact=potential --set "
                                           "simulation.integrator=sdirk2, which "
                                           "takes several times as long"
                                         : "");
}

DivergenceError with_advice(const DivergenceError& error, const RenderRequest& request,
                            const scenes::Scene& scene) {
  const bool is_stuck =
      error.tried_parts &&
      (has_moved_bodies(scene) ||
       (error.is_of_contact && scene.settings.contact == sim::ContactMethod::swept));
  const std::string advice =
      error.is_crushed || error.has_no_room || is_stuck
          ? other_beginning(scene, error)
          : fmt::format("To go on from the last of them, add {} to: {}", other_steps(scene, error),
                        resume_command(request.command_line));
  return DivergenceError(fmt::format("{}\nThe frames so far are whole. {}", error.what(), advice));
}

/// Scene -> world -> step stages -> frame -> PNG; the last three are in draw_frames.
void make_frames(const RenderRequest& request, const scenes::Scene& scene, const Frames& frames,
                 const RunFolder& folder, Progress& progress) {
  const sim::World start = prepare_world(request, scene, progress);
  render::Renderer renderer(picture_options(scene.picture, request.backend));
  RunLog log(
      folder, request.existing,
      {scene, start, frames, request.pictures, request.on_divergence, renderer.description()});
  if (log.finished() && log.lost().empty()) return progress.say("the run is finished already");
  if (log.is_new() && request.existing == ExistingRun::resume) {
    progress.say(fmt::format("{} holds no run to continue: this one starts from the beginning",
                             folder.path().string()));
  }

  const FrameBuilder builder(scene, start);
  RunCamera camera(scene, start, request.threads, request.on_divergence,
                   camera_events(scene, progress));
  FieldScale fields(request.pictures);
  const FrameOutput output = {builder, camera, fields, request.pictures, renderer, log};
  if (log.finished()) {
    Simulation again(scene, start, request.threads, request.on_divergence);
    return redraw_lost(again, output, progress);
  }
  if (log.seen()) camera.go_on(*log.seen());
  fields.go_on(log.fields_seen());
  log.append_launch(request.command_line, whole_path(request.video), request.threads);

  Simulation simulation(scene, log.world(), request.threads, request.on_divergence);
  try {
    draw_frames(simulation, frames.last, output, progress);
  } catch (const DivergenceError& error) {
    log.append_divergence(error.what());
    throw with_advice(error, request, scene);
  }
  log.close();
}

/// Before the run, which may take long. A run that goes on replaces the video that it was to
/// make before.
void check_video(const scenes::Scene& scene, const RenderRequest& request, const RunFolder& folder,
                 Progress& progress) {
  const std::string& video = request.video;
  check_video_place(video);
  const bool goes_on = request.existing == ExistingRun::resume && was_to_make(folder, video);
  if (request.existing != ExistingRun::overwrite && !goes_on) {
    refuse_to_replace(video, "name another file with --video");
  }
  if (is_animated_png(video)) return;
  if (const auto ffmpeg = find_program("ffmpeg")) {
    try_video(*ffmpeg, scene.picture.width, scene.picture.height, video);
  } else {
    check_video_ending(video);
    progress.say(
        "ffmpeg is not installed; after the run, the command for the video is printed. An animated "
        "picture, NAME.apng, is made without it");
  }
}

void make_video(const RunFolder& folder, const Frames& frames, int frames_per_second,
                const std::string& video) {
  if (is_animated_png(video)) {
    write_animated_png(folder, frames.first, frames.last, frames_per_second, video);
    fmt::print("{}\n", video);
    return;
  }
  const auto command = video_command(folder, frames, frames_per_second, video);
  if (const auto ffmpeg = find_program("ffmpeg")) {
    run_command(*ffmpeg, command);
    fmt::print("{}\n", video);
  } else {
    print_message("ffmpeg is not installed (apt-get install ffmpeg). The command for {}:\n{}\n",
                  video, shell_line(command));
  }
}

/// As a scene file in the run's folder.
void name_model_from(const RunFolder& folder, scenes::Scene& scene) {
  for (scenes::BodyScene& body : scene.bodies) {
    body.model.file = model_name_from(folder.path(), body.model.file);
  }
  scene.folder = folder.path();
}

/// What was chosen for a model does not replace a scene of the user's own, or one that he has
/// edited. Before the run, which may take long.
void check_kept_scene(const scenes::Scene& scene, const RunFolder& folder, ExistingRun existing) {
  const std::filesystem::path file = folder.scene();
  std::error_code ignored;
  if (existing == ExistingRun::overwrite || !std::filesystem::exists(file, ignored)) return;
  const std::vector<std::uint8_t> bytes = base::read_file(file.string());
  if (std::string(bytes.begin(), bytes.end()) == scenes::print_scene(scene)) return;
  throw base::IoError(fmt::format(
      "{} is there already and is not the scene that is chosen for the model and would be written "
      "there; to draw that file, name it in place of the model; to keep it, choose another folder "
      "with --out; to replace it, use --overwrite",
      file.string()));
}

/// What was chosen for a model, as a scene file of its own.
void keep_scene(const scenes::Scene& scene, const RunFolder& folder, ExistingRun existing) {
  check_kept_scene(scene, folder, existing);  // it may have been edited during the run
  const std::string text = scenes::print_scene(scene);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  base::write_file_atomically(folder.scene().string(), {bytes, text.size()});
  fmt::print("{}\n", folder.scene().string());
}

/// The last of the frames from all around, in place of the run's.
void make_turntable(const RenderRequest& request, const scenes::Scene& scene,
                    std::int64_t last_frame, const RunFolder& folder, Progress& progress) {
  if (request.existing != ExistingRun::overwrite) {
    refuse_to_replace(folder.frame(0), "choose another folder with --out");
  }
  folder.make();
  const sim::World start = prepare_world(request, scene, progress);
  render::Renderer renderer(picture_options(scene.picture, request.backend));
  Simulation simulation(scene, start, request.threads, request.on_divergence);
  while (simulation.frame() < last_frame) {
    throw_if_interrupted();
    progress.show(fmt::format("t = {:.2f} s", sim::time(simulation.world())));
    simulation.advance_frame();
  }
  // It goes around this moment, whatever the run comes to.
  const render::Camera camera =
      is_left_to_program(scene.camera)
          ? camera_around(scene, simulation.world())
          : RunCamera(scene, start, request.threads).at(simulation.world());
  const FrameBuilder builder(scene, start);
  draw_turntable(simulation, camera, builder, request.pictures.show, request.turntable, folder,
                 renderer, progress);
}

/// What is made of a run's pictures: sheet, video, comparison.
ExitCode make_more(const RenderRequest& request, const scenes::Scene& scene,
                   const RunFolder& pictures, const Frames& frames) {
  if (request.sheet) {
    write_contact_sheet(pictures, frames.first, frames.last, *request.sheet);
    fmt::print("{}\n", pictures.sheet().string());
  }
  if (!request.video.empty()) {
    make_video(pictures, frames, scene.picture.frames_per_second, request.video);
  }
  if (request.reference.folder.empty()) return ExitCode::done;
  return compare_with_reference(pictures, frames.first, frames.last, request.reference);
}

}  // namespace

ExitCode render_scene(const RenderRequest& request) {
  Progress progress(progress_style(request.quiet));
  auto [scene, choice] = with_nothing_to_keep([&] {
    return open_scene(request.scene, request.overrides, request.model, request.accuracy);
  });
  if (!choice.empty()) progress.say(choice);
  const Frames frames = frames_of(scene, request.frames);
  const RunFolder folder = folder_of(scene, request.out);
  const bool is_model = assets::has_model_ending(request.scene);
  if (is_model) name_model_from(folder, scene);
  try {
    if (!request.video.empty()) check_video(scene, request, folder, progress);
    const bool is_turned = request.turntable > 0;
    const RunFolder pictures = is_turned ? turntable_folder(folder) : folder;
    const Frames compared = is_turned ? Frames{0, request.turntable - 1} : frames;
    if (!request.reference.folder.empty()) {
      check_reference(pictures, compared.first, compared.last, scene.picture.width,
                      scene.picture.height, request.reference);
    }
    if (is_turned) {
      make_turntable(request, scene, frames.last, pictures, progress);
      fmt::print("{}\n", pictures.path().string());
      return make_more(request, scene, pictures, compared);
    }
    if (is_model) check_kept_scene(scene, folder, request.existing);
    make_frames(request, scene, frames, folder, progress);
    if (is_model) keep_scene(scene, folder, request.existing);
    fmt::print("{}\n", folder.path().string());
    return make_more(request, scene, folder, frames);
  } catch (const Interrupted&) {
    if (request.turntable > 0) throw;
    throw Interrupted("interrupted; continue with: " + resume_command(request.command_line));
  }
}

}  // namespace pneuma::app

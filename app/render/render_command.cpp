// `pneuma render`: its options.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <memory>

#include "app/host/errors.h"
#include "app/render/render_request.h"
#include "app/render/render_scene.h"
#include "app/render/turntable.h"
#include "app/terminal/command.h"
#include "app/terminal/common_options.h"
#include "app/terminal/number_text.h"

namespace pneuma::app {
namespace {

constexpr int greatest_sheet = 100;

/// The options as they were typed.
struct RenderArguments {
  RenderRequest request;
  std::string frames;
  std::string show;
  std::string overlay;
  std::string size;
  std::string sheet;
  std::string on_divergence;
  bool no_caption = false;
  bool overwrite = false;
  bool resume = false;
};

RenderRequest read(const RenderArguments& typed) {
  RenderRequest request = typed.request;
  if (!typed.frames.empty()) request.frames = parse_frames(typed.frames);
  if (!typed.show.empty()) request.pictures.show = parse_show("--show", typed.show);
  if (!typed.overlay.empty()) {
    request.pictures.overlay = parse_show("--overlay", typed.overlay);
  }
  if (!typed.sheet.empty()) request.sheet = parse_grid("--sheet", typed.sheet, greatest_sheet);
  if (typed.overwrite) request.existing = ExistingRun::overwrite;
  if (typed.resume) request.existing = ExistingRun::resume;
  if (typed.on_divergence == "stop") request.on_divergence = OnDivergence::stop;
  if (typed.on_divergence == "substep") request.on_divergence = OnDivergence::substep;
  // What the scene can say itself becomes part of the scene, and so of the run's record.
  if (!typed.size.empty()) append_size(typed.size, request.overrides);
  if (typed.no_caption) request.overrides.emplace_back("picture.caption=false");
  const std::string& reference = request.reference.folder;
  if (!reference.empty() && !std::filesystem::is_directory(reference)) {
    throw UsageError(fmt::format("--reference: there is no folder '{}'", reference));
  }
  return request;
}

}  // namespace

void add_render_command(CLI::App& app, Action& action, std::span<const std::string> command_line) {
  CLI::App* command = app.add_subcommand("render", "Turn a scene into PNG frames");
  const auto typed = std::make_shared<RenderArguments>();
  RenderRequest& request = typed->request;
  request.command_line.assign(command_line.begin(), command_line.end());

  add_scene_option(*command, request.scene);
  command->add_option("--out", request.out, "Folder for the frames [out/NAME]")->type_name("DIR");
  add_override_option(*command, request.overrides);
  add_accuracy_option(*command, request.accuracy);
  add_model_options(*command, request.model);
  add_frames_option(*command, typed->frames);
  command->add_option("--size", typed->size, "Size of the pictures in pixels, as 640x480")
      ->type_name("WxH");
  command
      ->add_option("--show", typed->show,
                   "What else to draw: wireframe, particles, contacts, impulses (arrows; none of "
                   "bodies that sleep; "
                   "impulses=0.5: of 0.5 N s a metre), ghost (rest shapes), labels, "
                   "scale; one of strain, velocity, pressure as colours, which end at the "
                   "largest value of the run so far or, as velocity=5, at a number")
      ->type_name("LIST");
  command
      ->add_option("--overlay", typed->overlay,
                   "A second picture of each frame, NAME_overlay_00042.png, with this also drawn")
      ->type_name("LIST");
  command->add_flag("--no-caption", typed->no_caption, "Leave out scene, time and step");
  auto* overwrite =
      command->add_flag("--overwrite", typed->overwrite,
                        "Replace the run in the folder, the video, and of a model its scene file "
                        "NAME.toml");
  command->add_flag("--resume", typed->resume, "Continue the interrupted run in the folder")
      ->excludes(overwrite);
  command
      ->add_option(
          "--on-divergence", typed->on_divergence,
          fmt::format("What to do about a step that diverges: stop, or substep, which does "
                      "it again in up to {} parts [substep, where the step is short enough for "
                      "small motions]",
                      greatest_step_parts))
      ->check(CLI::IsMember({"stop", "substep"}));
  command->add_option("--sheet", typed->sheet, "Also a contact sheet, as 4x3")->type_name("CxR");
  command
      ->add_option("--video", request.video,
                   "Also a video, by ffmpeg; an animated picture as NAME.apng, without it")
      ->type_name("FILE");
  auto* turntable =
      command
          ->add_option("--turntable", request.turntable,
                       "In place of the run's pictures so many of its last frame, seen from all "
                       "around: turntable/NAME_00000.png, ...")
          ->check(CLI::Range(1, max_turntable))
          ->type_name("N");
  turntable->excludes("--overlay")->excludes("--resume");
  command
      ->add_option("--reference", request.reference.folder,
                   "A folder with the same pictures: exit code 7 if one is further from it than "
                   "--threshold")
      ->type_name("DIR");
  command
      ->add_option("--threshold", request.reference.threshold,
                   "Mean difference of two pictures that is let pass, 0..255 [0]")
      ->check(number_range(0.0, 255.0))
      ->needs("--reference")
      ->type_name("X");
  add_backend_option(*command, request.backend);
  add_threads_option(*command, request.threads);
  add_quiet_option(*command, request.quiet);
  add_examples(
      *command,
      {"pneuma render pressure_soft", "pneuma render one_torus --sheet 4x3 --out torus",
       "pneuma render one_sphere --set body.k=200 --set duration=4 --show wireframe --out stiff",
       "pneuma render pressure_firm --video firm.mp4",
       "pneuma render two_spheres_contact --show particles,contacts,wireframe",
       "pneuma render sphere_in_torus --overlay particles",
       "pneuma render press --show strain,ghost,labels,scale",
       "pneuma render cat_on_sphere --frames 60 --turntable 90 --video cat.apng",
       "pneuma render one_torus --reference torus --threshold 0.5", "pneuma render two_balls.toml",
       "pneuma render my_scene.toml --out pictures --frames 60 --size 640x480 --resume"});
  command->callback([typed, &action] { action = [typed] { return render_scene(read(*typed)); }; });
}

}  // namespace pneuma::app

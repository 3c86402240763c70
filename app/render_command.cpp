// `pneuma render`: its options.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>

#include "app/command.h"
#include "app/render_request.h"
#include "app/render_scene.h"

namespace pneuma::app {
namespace {

constexpr int greatest_picture = 8192;  // pixels along a side: what the renderer takes
constexpr int greatest_sheet = 100;

/// The options as they were typed.
struct Typed {
  RenderRequest request;
  std::string frames;
  std::string show;
  std::string overlay;
  std::string size;
  std::string sheet;
  bool no_caption = false;
  bool overwrite = false;
  bool resume = false;
};

RenderRequest read(const Typed& typed) {
  RenderRequest request = typed.request;
  if (!typed.frames.empty()) request.frames = parse_frames(typed.frames);
  if (!typed.show.empty()) request.pictures.show = parse_show("--show", typed.show);
  if (!typed.overlay.empty()) {
    request.pictures.overlay = parse_show("--overlay", typed.overlay);
  }
  if (!typed.sheet.empty()) request.sheet = parse_grid("--sheet", typed.sheet, greatest_sheet);
  if (typed.overwrite) request.existing = ExistingRun::overwrite;
  if (typed.resume) request.existing = ExistingRun::resume;
  // What the scene can say itself becomes part of the scene, and so of the run's record.
  if (!typed.size.empty()) {
    const GridSize size = parse_grid("--size", typed.size, greatest_picture);
    request.overrides.push_back(fmt::format("picture.width={}", size.columns));
    request.overrides.push_back(fmt::format("picture.height={}", size.rows));
  }
  if (typed.no_caption) request.overrides.emplace_back("picture.caption=false");
  return request;
}

}  // namespace

void add_render_command(CLI::App& app, Action& action, std::span<const std::string> command_line) {
  CLI::App* command = app.add_subcommand("render", "Turn a scene into PNG frames");
  const auto typed = std::make_shared<Typed>();
  RenderRequest& request = typed->request;
  request.command_line.assign(command_line.begin(), command_line.end());

  command->add_option("scene", request.scene, "A scene file, or the name of one in scenes/")
      ->required()
      ->type_name("SCENE");
  command->add_option("--out", request.out, "Folder for the frames [out/NAME]")->type_name("DIR");
  command->add_option("--set", request.overrides, "Override a value of the scene, as body.k=200")
      ->type_name("PATH=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--frames", typed->frames, "The first N frames, or a part as 10-20, or 10-")
      ->type_name("N");
  command->add_option("--size", typed->size, "Size of the pictures in pixels, as 640x480")
      ->type_name("WxH");
  command->add_option("--show", typed->show, "What else to draw: wireframe, particles, contacts")
      ->type_name("LIST");
  command
      ->add_option("--overlay", typed->overlay,
                   "A second picture of each frame, NAME_overlay_00042.png, with this also drawn")
      ->type_name("LIST");
  command->add_flag("--no-caption", typed->no_caption, "Leave out scene, time and step");
  auto* overwrite =
      command->add_flag("--overwrite", typed->overwrite, "Replace the run in the folder");
  command->add_flag("--resume", typed->resume, "Continue the interrupted run in the folder")
      ->excludes(overwrite);
  command->add_option("--sheet", typed->sheet, "Also a contact sheet, as 4x3")->type_name("CxR");
  command->add_option("--video", request.video, "Also a video, by ffmpeg")->type_name("FILE");
  command->add_option("--threads", request.threads, "Threads of the simulation [1]")
      ->check(CLI::Range(1, 256));
  command->add_flag("--quiet", request.quiet, "No progress, only errors");
  command->callback([typed, &action] { action = [typed] { return render_scene(read(*typed)); }; });
}

}  // namespace pneuma::app

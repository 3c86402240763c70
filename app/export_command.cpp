// `pneuma export`: its options.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <map>
#include <memory>

#include "app/command.h"
#include "app/export_scene.h"

namespace pneuma::app {

void add_export_command(CLI::App& app, Action& action) {
  struct Typed {
    ExportRequest request;
    std::string frames;
    std::string format = "ply";
  };
  static const std::map<std::string, MeshFormat> formats = {
      {"ply", MeshFormat::ply}, {"obj", MeshFormat::obj}, {"glb", MeshFormat::glb}};
  CLI::App* command =
      app.add_subcommand("export", "Write the bodies of each frame as mesh files, no pictures");
  const auto typed = std::make_shared<Typed>();
  ExportRequest& request = typed->request;

  command->add_option("scene", request.scene, "A scene file, or the name of one in scenes/")
      ->required()
      ->type_name("SCENE");
  command->add_option("--format", typed->format, "ply (double precision), obj or glb [ply]")
      ->check(CLI::IsMember(formats))
      ->type_name("FORMAT");
  command->add_option("--out", request.out, "Folder for the files [out/NAME]")->type_name("DIR");
  command->add_option("--set", request.overrides, "Override a value of the scene, as body.k=200")
      ->type_name("PATH=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--frames", typed->frames, "The first N frames, or a part as 10-20, or 10-")
      ->type_name("N");
  command->add_flag("--overwrite", request.overwrite, "Replace the mesh files in the folder");
  command->add_option("--threads", request.threads, "Threads of the simulation [1]")
      ->check(CLI::Range(1, 256));
  command->add_flag("--quiet", request.quiet, "No progress, only errors");
  command->callback([typed, &action] {
    action = [typed] {
      typed->request.format = formats.at(typed->format);
      if (!typed->frames.empty()) typed->request.frames = parse_frames(typed->frames);
      return export_scene(typed->request);
    };
  });
}

}  // namespace pneuma::app

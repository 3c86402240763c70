// `pneuma export`: its options.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <set>
#include <string>

#include "app/export/export_scene.h"
#include "app/terminal/command.h"
#include "app/terminal/common_options.h"

namespace pneuma::app {

void add_export_command(CLI::App& app, Action& action) {
  struct Typed {
    ExportRequest request;
    std::string frames;
    std::string format = "ply";
    bool animated = false;
  };
  std::set<std::string> names;
  for (const ExportFormat& format : export_formats()) names.emplace(format.name);
  CLI::App* command = app.add_subcommand("export", "Write a run as files that other programs show");
  const auto typed = std::make_shared<Typed>();
  ExportRequest& request = typed->request;

  add_scene_option(*command, request.scene);
  command
      ->add_option("--format", typed->format,
                   "A mesh file per frame: ply (double precision), obj, glb or vtp (for ParaView, "
                   "with velocities and times); npz: one file of arrays for NumPy; html: one page "
                   "that plays the run in a browser [ply]")
      ->check(CLI::IsMember(names))
      ->type_name("FORMAT");
  command->add_flag("--animated", typed->animated,
                    "All frames in one file: glb (for three.js, Blender) or obj with a pc2 beside "
                    "it (Blender's Mesh Cache)");
  command->add_option("--out", request.out, "Folder for the files [out/NAME]")->type_name("DIR");
  add_override_option(*command, request.overrides);
  add_accuracy_option(*command, request.accuracy);
  add_model_options(*command, request.model);
  add_frames_option(*command, typed->frames);
  command->add_flag("--overwrite", request.overwrite, "Replace such files in the folder");
  add_threads_option(*command, request.threads);
  add_quiet_option(*command, request.quiet);
  add_examples(*command, {"pneuma export pressure_soft --format ply --out meshes",
                          "pneuma export one_torus --format html",
                          "pneuma export one_torus --format glb --animated",
                          "pneuma export one_torus --format npz",
                          "pneuma export my_scene.toml --format obj --frames 30 --overwrite"});
  command->callback([typed, &action] {
    action = [typed] {
      typed->request.format = export_format(typed->format, typed->animated);
      if (!typed->frames.empty()) typed->request.frames = parse_frames(typed->frames);
      return export_scene(typed->request);
    };
  });
}

}  // namespace pneuma::app

// pneuma check: a scene as the program understands it, and what a run of it comes to; or a model.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/accuracy/choose_step.h"
#include "app/check/check_model.h"
#include "app/check/check_report.h"
#include "app/check/judge_run.h"
#include "app/check/keys_json.h"
#include "app/files/find_model.h"
#include "app/host/errors.h"
#include "app/host/interrupt.h"
#include "app/host/standard_streams.h"
#include "app/picture/place_camera.h"
#include "app/terminal/command.h"
#include "app/terminal/common_options.h"
#include "app/world/model_scene.h"
#include "app/world/open_scene.h"
#include "app/world/scene_warnings.h"
#include "assets/model_file.h"
#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"

namespace pneuma::app {
namespace {

struct CheckOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::optional<Accuracy> accuracy;
  ModelChoice model;
  bool run = false;
  bool no_scene = false;
  bool keys = false;
  bool json = false;
  int threads = 1;
};

ExitCode check_model_file(const CheckOptions& options) {
  const std::filesystem::path path = find_model(options.scene, "");
  const ModelCheck checked = check_model(path, options.model);
  if (options.json) {
    fmt::print("{}\n", model_check_json(checked).dump(2));
    return ExitCode::done;
  }
  const std::string text = model_scene_text(path, options.model);
  const int steps = scenes::parse_scene(text, model_scene_file(path)).settings.steps_per_second;
  fmt::print("{}{}\nThe scene that `pneuma render` makes of it\n\n{}", model_check_text(checked),
             many_steps_text(checked.report, steps), text);
  return ExitCode::done;
}

/// Says it when bodies passed through each other.
ExitCode judge(const scenes::Scene& scene, const RunStatistics& run) {
  const RunVerdict verdict = judge_run(scene, run);
  std::fflush(stdout);
  print_message("{}", verdict.words);
  return verdict.code;
}

/// Of a camera that the scene leaves to the program nothing is known before a run.
void warn(const CheckReport& report, const sim::World& world) {
  for (const std::string& warning : scene_warnings(report.scene, world, report.steps, report.gas)) {
    print_message("{}\n", warning);
  }
  const std::string hidden = what_camera_misses(report.scene, world);
  if (!hidden.empty()) print_message("{}: {}\n", report.scene.name, hidden);
}

std::string report_text(const CheckReport& report, const CheckOptions& options) {
  if (options.json) {
    return (options.no_scene ? run_json(report) : check_json(report)).dump(2) + "\n";
  }
  return options.no_scene ? run_statistics_text(*report.run, report.scene.settings)
                          : check_text(report);
}

ExitCode check(const CheckOptions& options) {
  if (options.keys) {
    fmt::print("{}", options.json ? keys_json().dump(2) + "\n" : scenes::scene_reference());
    return ExitCode::done;
  }
  if (options.scene.empty()) {
    throw UsageError("check: name a scene, or ask for the reference of all keys with --keys");
  }
  const NothingToKeep nothing;
  const bool as_scene = options.run || !options.overrides.empty() || options.accuracy;
  if (assets::has_model_ending(options.scene) && !as_scene) return check_model_file(options);
  CheckReport report;
  const AccurateScene opened =
      open_scene(options.scene, options.overrides, options.model, options.accuracy);
  if (!opened.choice.empty()) print_message("{}\n", opened.choice);
  report.scene = opened.scene;
  const sim::World world = build_checked_world(report.scene);
  report.plan = sim::make_plan(world);
  report.size = world_size(world);
  report.steps = step_advices(world);
  report.gas = gas_advices(world);
  warn(report, world);
  if (options.run) report.run = run_statistics(report.scene, options.threads);
  fmt::print("{}", report_text(report, options));
  if (!report.run) return ExitCode::done;
  if (report.run->divergence) throw DivergenceError(*report.run->divergence);
  return judge(report.scene, *report.run);
}

}  // namespace

void add_check_command(CLI::App& app, Action& action) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* command =
      app.add_subcommand("check",
                         "Print a scene's effective values and the stages that will run, or what "
                         "a model is like");
  command
      ->add_option("scene", options->scene,
                   "A scene file, or the name of one in scenes/; or a model file (" +
                       assets::model_endings() + ")")
      ->type_name("SCENE|MODEL");
  add_override_option(*command, options->overrides);
  add_accuracy_option(*command, options->accuracy);
  add_model_options(*command, options->model);
  CLI::Option* run = command->add_flag(
      "--run", options->run,
      "Also run it without pictures: penetration, energy, contacts, volumes; exit code 7 if "
      "bodies pass through each other");
  command
      ->add_flag("--no-scene", options->no_scene,
                 "Of --run: print what it comes to, without the scene, its stages and sizes")
      ->needs(run);
  command->add_flag("--keys", options->keys, "Print the reference of all keys of scene files");
  add_threads_option(*command, options->threads);
  command->add_flag("--json", options->json, "JSON in place of text");
  add_examples(*command, {"pneuma check one_torus", "pneuma check two_balls.toml --run --no-scene",
                          "pneuma check one_sphere --run --set simulation.steps_per_second=120",
                          "pneuma check --keys"});
  command->callback([options, &action] { action = [options] { return check(*options); }; });
}

}  // namespace pneuma::app

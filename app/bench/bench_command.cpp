// pneuma bench: the paper's table of frame rates, measured here.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/bench/bench_report.h"
#include "app/files/scene_catalogue.h"
#include "app/host/errors.h"
#include "app/host/interrupt.h"
#include "app/host/standard_streams.h"
#include "app/host/timing_conditions.h"
#include "app/record/provenance.h"
#include "app/terminal/command.h"
#include "app/terminal/common_options.h"
#include "app/terminal/grid_size.h"
#include "app/terminal/number_text.h"
#include "app/world/open_scene.h"

namespace pneuma::app {
namespace {

struct BenchOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> overrides;
  std::optional<std::string> size;
  std::string show;
  MeasureOptions measure;
  bool json = false;
};

/// The paper's own windows had about this size.
constexpr const char* default_size = "640x480";

/// Later ones win: a size that was asked for wins over --set, and that over the default size.
std::vector<std::string> all_overrides(const BenchOptions& options) {
  std::vector<std::string> overrides;
  append_size(default_size, overrides);
  std::ranges::copy(options.overrides, std::back_inserter(overrides));
  if (options.size) append_size(*options.size, overrides);
  return overrides;
}

std::vector<scenes::Scene> load_scenes(const BenchOptions& options) {
  const NothingToKeep nothing;
  std::vector<std::string> names = options.scenes;
  if (names.empty()) {
    for (const auto& path : scenes_of_the_paper()) names.push_back(path.string());
  }
  std::vector<scenes::Scene> loaded;
  const std::vector<std::string> overrides = all_overrides(options);
  for (const std::string& name : names) loaded.push_back(open_scene(name, overrides));
  return loaded;
}

ExitCode bench(const BenchOptions& options) {
  BenchReport report;
  report.options = options.measure;
  report.date = utc_date();
  report.warnings = timing_warnings(timing_conditions());

  ExitCode code = ExitCode::done;
  const std::vector<scenes::Scene> scenes = load_scenes(options);
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    print_message("{}/{} {}\n", i + 1, scenes.size(), scenes[i].name);
    try {
      report.scenes.push_back(measure_scene(scenes[i], options.measure));
      report.scenes.back().paper_method = measure_paper_method(scenes[i], options.measure);
    } catch (const DivergenceError& error) {  // the other scenes are still worth measuring
      report.warnings.push_back(fmt::format("{} is missing: {}", scenes[i].name, error.what()));
      code = ExitCode::diverged;
    }
  }
  std::ranges::copy(measurement_warnings(report.scenes), std::back_inserter(report.warnings));
  fmt::print("{}", options.json ? bench_json(report).dump(2) + "\n" : bench_text(report));
  return code;
}

}  // namespace

void add_bench_command(CLI::App& app, Action& action) {
  const auto options = std::make_shared<BenchOptions>();
  CLI::App* command =
      app.add_subcommand("bench", "Measure frames per second beside the paper's, stage by stage");
  command
      ->add_option("scene", options->scenes,
                   "Scene files or names [all that the paper gives a frame rate for]")
      ->type_name("SCENE");
  add_override_option(*command, options->overrides);
  auto* steps =
      command->add_option("--steps", options->measure.steps, "Measure N steps, and as many frames")
          ->type_name("N")
          ->check(CLI::Range(1, 10'000'000));
  command
      ->add_option("--seconds", options->measure.seconds,
                   "Measure a scene's steps for S seconds, and its frames for as long [1]")
      ->type_name("S")
      ->check(number_range(0.01, 3600.0))
      ->excludes(steps);
  command
      ->add_option("--warm-up", options->measure.warm_up,
                   "Leave out the scene's first S seconds, at most half of it [half of it]")
      ->type_name("S")
      ->check(number_range(0.0, 3600.0));
  auto* no_pictures = command->add_flag_callback(
      "--no-pictures", [options] { options->measure.pictures = false; },
      "Measure the simulation only; needs no OpenGL");
  command
      ->add_option("--size", options->size,
                   fmt::format("Size of the pictures in pixels [{}]", default_size))
      ->type_name("WxH");
  command
      ->add_option("--show", options->show,
                   "What else to draw, as in pneuma render: particles are made in the steps, too")
      ->type_name("LIST")
      ->excludes(no_pictures);
  add_backend_option(*command, options->measure.backend);
  add_threads_option(*command, options->measure.threads);
  command->add_flag("--json", options->json, "JSON in place of tables");
  add_examples(*command,
               {"pneuma bench", "pneuma bench one_sphere --no-pictures --json",
                "pneuma bench one_sphere one_torus --seconds 5",
                "pneuma bench torus_three_spheres --size 1280x720 --show particles",
                "pneuma bench one_sphere --set simulation.integrator=implicit_euler --json"});
  command->callback([options, &action] {
    action = [options] {
      if (!options->show.empty()) options->measure.show = parse_show("--show", options->show);
      return bench(*options);
    };
  });
}

}  // namespace pneuma::app

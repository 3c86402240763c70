// pneuma bench: the paper's table of frame rates, measured here.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/bench_report.h"
#include "app/command.h"
#include "app/common_options.h"
#include "app/errors.h"
#include "app/find_scene.h"
#include "app/provenance.h"
#include "app/render_request.h"
#include "app/scene_catalogue.h"
#include "app/timing_conditions.h"
#include "scenes/load_scene.h"

namespace pneuma::app {
namespace {

struct BenchOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> overrides;
  std::optional<std::string> size;
  MeasureOptions measure;
  bool json = false;
};

/// The paper's own windows had about this size.
constexpr const char* default_size = "640x480";

/// As values for the scene's keys, so that the scene stays the one place that says it.
void add_size(const std::string& size, std::vector<std::string>& overrides) {
  const GridSize grid = parse_grid("--size", size, scenes::greatest_picture_side);
  overrides.push_back(fmt::format("picture.width={}", grid.columns));
  overrides.push_back(fmt::format("picture.height={}", grid.rows));
}

/// Later ones win: a size that was asked for wins over --set, and that over the default size.
std::vector<std::string> all_overrides(const BenchOptions& options) {
  std::vector<std::string> overrides;
  add_size(default_size, overrides);
  std::ranges::copy(options.overrides, std::back_inserter(overrides));
  if (options.size) add_size(*options.size, overrides);
  return overrides;
}

std::vector<scenes::Scene> load_scenes(const BenchOptions& options) {
  std::vector<std::filesystem::path> paths;
  for (const std::string& name : options.scenes) paths.push_back(find_scene(name));
  if (paths.empty()) paths = scenes_of_the_paper();

  std::vector<scenes::Scene> loaded;
  const std::vector<std::string> overrides = all_overrides(options);
  for (const auto& path : paths) loaded.push_back(scenes::load_scene(path, overrides));
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
    fmt::print(stderr, "{}/{} {}\n", i + 1, scenes.size(), scenes[i].name);
    try {
      report.scenes.push_back(measure_scene(scenes[i], options.measure));
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
      ->check(CLI::Range(0.01, 3600.0))
      ->excludes(steps);
  command
      ->add_option("--warm-up", options->measure.warm_up,
                   "Leave out the scene's first S seconds, at most half of it [half of it]")
      ->type_name("S")
      ->check(CLI::Range(0.0, 3600.0));
  command->add_flag_callback(
      "--no-pictures", [options] { options->measure.pictures = false; },
      "Measure the simulation only; needs no OpenGL");
  command
      ->add_option("--size", options->size,
                   fmt::format("Size of the pictures in pixels [{}]", default_size))
      ->type_name("WxH");
  add_threads_option(*command, options->measure.threads);
  command->add_flag("--json", options->json, "JSON in place of tables");
  command->callback([options, &action] { action = [options] { return bench(*options); }; });
}

}  // namespace pneuma::app

// pneuma study horizons: its options, and what it leaves.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/host/errors.h"
#include "app/host/interrupt.h"
#include "app/record/provenance.h"
#include "app/record/vector_json.h"
#include "app/study/csv.h"
#include "app/study/horizon/horizon_study.h"
#include "app/study/report_text.h"
#include "app/study/study_command.h"
#include "app/study/study_folder.h"
#include "app/study/study_options.h"
#include "app/terminal/common_options.h"
#include "app/terminal/number_text.h"
#include "app/terminal/progress.h"
#include "app/terminal/table.h"
#include "app/world/open_scene.h"

namespace pneuma::app {
namespace {

struct HorizonArguments : StudyOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> overrides;
  std::optional<double> seconds;
  std::optional<double> difference;
  std::optional<int> tries;
  bool quiet = false;
};

std::string time_cell(const std::optional<double>& seconds) {
  return seconds ? fmt::format("{:.2f}", *seconds) : "-";
}

std::string doubling_cell(double growth_rate) {
  return growth_rate > 0.0 ? readable(std::numbers::ln2 / growth_rate) : "-";
}

std::string table_of(const std::vector<Horizon>& horizons, double start) {
  const std::string group = fmt::format("s until {:.0e} has become", start);
  std::vector<Table::Column> columns = {{"scene", Table::Align::left},
                                        {"compared\nuntil, s"},
                                        {"growth\nrate, 1/s"},
                                        {"doubles\nin, s"}};
  for (const double size : told_sizes) {
    columns.push_back({power_of_ten(size), Table::Align::right, group});
  }
  columns.push_back({"at the\nend"});
  Table table(std::move(columns));
  for (const Horizon& horizon : horizons) {
    const Difference& last = horizon.differences.back();
    std::vector<std::string> cells = {horizon.name, fmt::format("{:.4g}", last.time),
                                      readable(horizon.growth_rate),
                                      doubling_cell(horizon.growth_rate)};
    for (const double size : told_sizes) cells.push_back(time_cell(horizon.exceeds(size)));
    cells.push_back(fmt::format("{:.1e}", last.size));
    table.add_row(std::move(cells));
  }
  return table.text();
}

std::string horizons_csv(const std::vector<Horizon>& horizons) {
  Csv csv({"scene", "time_s", "difference"});
  for (const Horizon& horizon : horizons) {
    for (const auto& [time, size] : horizon.differences) {
      csv.add_row({csv_cell(horizon.name), csv_cell(time), csv_cell(size)});
    }
  }
  return csv.text();
}

nlohmann::json horizon_json(const Horizon& horizon) {
  nlohmann::json exceeds = nlohmann::json::object();
  for (const double size : told_sizes) {
    const auto seconds = horizon.exceeds(size);
    exceeds[power_of_ten(size)] = seconds ? nlohmann::json(*seconds) : nlohmann::json(nullptr);
  }
  return {{"scene", horizon.name},
          {"start", horizon.start},
          {"seconds", horizon.differences.back().time},
          {"growth_rate_per_s", number_json(horizon.growth_rate)},
          {"exceeds_at_s", std::move(exceeds)},
          {"at_the_end", horizon.differences.back().size}};
}

/// A short study is so where nothing else was typed.
HorizonOptions horizon_options(const HorizonArguments& typed) {
  HorizonOptions options;
  if (typed.is_short) options = {.tries = 1, .seconds = 1.0};
  if (typed.seconds) options.seconds = typed.seconds;
  options.difference = typed.difference.value_or(options.difference);
  options.tries = typed.tries.value_or(options.tries);
  return options;
}

std::vector<scenes::Scene> open_scenes(const HorizonArguments& typed) {
  const NothingToKeep nothing;
  std::vector<scenes::Scene> scenes;
  for (const std::string& name : typed.scenes) scenes.push_back(open_scene(name, typed.overrides));
  return scenes;
}

ExitCode run_horizon_study(const HorizonArguments& typed) {
  const HorizonOptions options = horizon_options(typed);
  const std::vector<scenes::Scene> scenes = open_scenes(typed);
  const StudyFolder folder =
      open_study_folder(typed, {{"horizons.json", "horizons.csv"}, {"horizons"}});
  Progress progress(progress_style(typed.quiet));
  std::vector<Horizon> horizons;
  std::vector<std::string> warnings;
  for (const scenes::Scene& scene : scenes) {
    try {
      horizons.push_back(study_horizon(scene, options, [&](const std::string& what) {
        progress.show(fmt::format("{}: {}", scene.name, what));
      }));
    } catch (const DivergenceError& error) {  // the other scenes are still worth a look
      warnings.push_back(fmt::format("{} is missing: {}", scene.name, error.what()));
    }
  }
  nlohmann::json json = study_head(typed);
  json.update({{"warnings", warnings}, {"scenes", nlohmann::json::array()}});
  for (const Horizon& horizon : horizons) json["scenes"].push_back(horizon_json(horizon));
  folder.write("horizons.json", json.dump(2) + '\n');
  folder.write("horizons.csv", horizons_csv(horizons));
  if (!horizons.empty()) {
    write_diagram(folder, "horizons", horizon_diagram(horizons));
    fmt::print("{}\n", table_of(horizons, options.difference));
  }
  fmt::print("{}{}{}\n", provenance_text(json["date"]), warnings_text(warnings),
             folder.path().string());
  return warnings.empty() ? ExitCode::done : ExitCode::diverged;
}

}  // namespace

void add_horizon_study(CLI::App& study, Action& action, std::span<const std::string> command_line) {
  const auto typed = std::make_shared<HorizonArguments>();
  CLI::App* command = study.add_subcommand(
      "horizons", "How a small difference at the start grows: for how long a motion can be told");
  command->add_option("scene", typed->scenes, "Scene files or names")
      ->required()
      ->type_name("SCENE");
  add_override_option(*command, typed->overrides);
  command
      ->add_option("--seconds", typed->seconds,
                   "Simulated time, at most the scene's own [all of it; with --short 1]")
      ->type_name("S")
      ->check(number_range(0.1, 3600.0));
  command
      ->add_option("--difference", typed->difference,
                   "At the start, root mean square over the vertices, in rest radii [1e-9]")
      ->type_name("X")
      ->check(number_range(1e-14, 1e-2));
  command->add_option("--tries", typed->tries, "With other differences each [3; with --short 1]")
      ->type_name("N")
      ->check(CLI::Range(1, 100));
  add_study_options(*command, *typed, command_line, "A second of each: to see that it works");
  add_quiet_option(*command, typed->quiet);
  command->callback([typed, &action] { action = [typed] { return run_horizon_study(*typed); }; });
}

}  // namespace pneuma::app

// pneuma study growth: its options, and what it leaves.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/study/csv.h"
#include "app/study/growth/growth_study.h"
#include "app/study/study_command.h"
#include "app/study/study_folder.h"
#include "app/study/study_options.h"
#include "app/terminal/common_options.h"
#include "app/terminal/progress.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

struct GrowthArguments : StudyOptions {
  bool quiet = false;
};

void print(const std::vector<GrowthSeries>& all) {
  using Align = Table::Align;
  Table table({{"pieces", Align::left},
               {"number"},
               {"us per step"},
               {"us per step\nand piece"},
               {"steps per\nsecond"},
               {"ms per simulated\nsecond"}});
  for (const GrowthSeries& series : all) {
    for (const GrowthPoint& point : series.points) {
      const double step = 1e6 * point.step_seconds;
      table.add_row({series.name, readable(point.size), readable(step), readable(step / point.size),
                     readable(point.steps_per_second), readable(1e3 * point.seconds_per_second())});
    }
  }
  fmt::print("{}\n", table.text());
  for (const GrowthSeries& series : all) {
    fmt::print("time grows with the number of {} to the power of {:.2f}, of a step {:.2f}\n",
               series.name, series.second.exponent, series.step.exponent);
  }
}

ExitCode run_growth_study(const GrowthArguments& typed) {
  const StudyFolder folder = open_study_folder(typed, {{"growth.csv", "growth.json"}, {"growth"}});
  Progress progress(progress_style(typed.quiet));
  const GrowthOptions options{.few = typed.is_short,
                              .seconds_per_point = typed.is_short ? 0.05 : 1.0};
  const std::vector<GrowthSeries> all =
      study_growth(options, [&](const std::string& what) { progress.show(what); });
  Csv csv({"pieces", "number", "step_s", "steps_per_second", "step_exponent", "second_exponent"});
  nlohmann::json json = study_head(typed);
  for (const GrowthSeries& series : all) {
    nlohmann::json points = nlohmann::json::array();
    for (const GrowthPoint& point : series.points) {
      csv.add_row({csv_cell(series.name), csv_cell(point.size), csv_cell(point.step_seconds),
                   csv_cell(point.steps_per_second), csv_cell(series.step.exponent),
                   csv_cell(series.second.exponent)});
      points.push_back({{"number", point.size},
                        {"step_s", point.step_seconds},
                        {"steps_per_second", point.steps_per_second}});
    }
    json["series"].push_back({{"pieces", series.name},
                              {"step_exponent", series.step.exponent},
                              {"second_exponent", series.second.exponent},
                              {"points", points}});
  }
  folder.write("growth.csv", csv.text());
  folder.write("growth.json", json.dump(2) + '\n');
  write_diagram(folder, "growth", growth_diagram(all));
  print(all);
  fmt::print("{}\n", folder.path().string());
  return ExitCode::done;
}

}  // namespace

void add_growth_study(CLI::App& study, Action& action, std::span<const std::string> command_line) {
  const auto typed = std::make_shared<GrowthArguments>();
  CLI::App* command = study.add_subcommand(
      "growth", "How the time of a simulated second grows with the size of a scene");
  add_study_options(*command, *typed, command_line, "Two sizes each: seconds");
  add_quiet_option(*command, typed->quiet);
  command->callback([typed, &action] { action = [typed] { return run_growth_study(*typed); }; });
}

}  // namespace pneuma::app

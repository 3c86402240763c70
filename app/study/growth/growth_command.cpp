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
  Table table({{"pieces", Align::left}, {"number"}, {"us per step"}, {"us per step\nand piece"}});
  for (const GrowthSeries& series : all) {
    for (const auto& [size, seconds] : series.points) {
      table.add_row(
          {series.name, readable(size), readable(1e6 * seconds), readable(1e6 * seconds / size)});
    }
  }
  fmt::print("{}\n", table.text());
  for (const GrowthSeries& series : all) {
    fmt::print("time grows with the number of {} to the power of {:.2f}\n", series.name,
               series.law.exponent);
  }
}

ExitCode run_growth_study(const GrowthArguments& typed) {
  const StudyFolder folder(typed.out);
  Progress progress(progress_style(typed.quiet));
  const GrowthOptions options{.few = typed.is_short,
                              .seconds_per_point = typed.is_short ? 0.05 : 1.0};
  const std::vector<GrowthSeries> all =
      study_growth(options, [&](const std::string& what) { progress.show(what); });
  Csv csv({"pieces", "number", "step_s", "exponent"});
  nlohmann::json json = study_head(typed);
  for (const GrowthSeries& series : all) {
    nlohmann::json points = nlohmann::json::array();
    for (const auto& [size, seconds] : series.points) {
      csv.add_row({csv_cell(series.name), csv_cell(size), csv_cell(seconds),
                   csv_cell(series.law.exponent)});
      points.push_back({{"number", size}, {"step_s", seconds}});
    }
    json["series"].push_back(
        {{"pieces", series.name}, {"exponent", series.law.exponent}, {"points", points}});
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
  CLI::App* command =
      study.add_subcommand("growth", "How the time of a step grows with the size of a scene");
  add_study_options(*command, *typed, command_line, "Two sizes each: seconds");
  add_quiet_option(*command, typed->quiet);
  command->callback([typed, &action] { action = [typed] { return run_growth_study(*typed); }; });
}

}  // namespace pneuma::app

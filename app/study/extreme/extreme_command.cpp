// pneuma study extremes: its options, and what it leaves.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/host/interrupt.h"
#include "app/record/vector_json.h"
#include "app/study/csv.h"
#include "app/study/extreme/extreme_run.h"
#include "app/study/study_command.h"
#include "app/study/study_folder.h"
#include "app/study/study_options.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

struct Row {
  ExtremeCase extreme;
  std::string integrator;
  bool implicit = false;
  ExtremeResult result;

  bool expected() const { return as_expected(extreme, implicit, result); }
  std::string expectation() const {
    return implicit ? to_string(extreme.implicit_outcome) : to_string(extreme.explicit_outcomes);
  }
};

std::string cell(const Row& row) {
  std::string text = to_string(row.result.outcome);
  if (row.result.outcome == Outcome::diverged)
    text += fmt::format(" at {:.3g} s", row.result.seconds);
  if (row.result.penetration > 0.0) {
    text += fmt::format(", {:.2g} m deep", row.result.penetration);
  }
  if (!row.expected()) text += "\nNOT AS EXPECTED: " + row.expectation();
  return text;
}

std::string csv_text(const std::vector<Row>& rows) {
  Csv csv({"case", "integrator", "expected", "outcome", "as_expected", "seconds", "energy_gain_J",
           "energy_span_J", "least_volume_share", "penetration_m", "greatest_speed_m_per_s",
           "message"});
  for (const Row& row : rows) {
    const ExtremeResult& result = row.result;
    csv.add_row({csv_cell(row.extreme.name), csv_cell(row.integrator), csv_cell(row.expectation()),
                 csv_cell(to_string(result.outcome)), csv_cell(row.expected()),
                 csv_cell(result.seconds), csv_cell(result.energy_gain),
                 csv_cell(result.energy_span), csv_cell(result.least_volume_share),
                 csv_cell(result.penetration), csv_cell(result.greatest_speed),
                 csv_cell(result.message)});
  }
  return csv.text();
}

nlohmann::json rows_json(const std::vector<Row>& rows) {
  nlohmann::json all = nlohmann::json::array();
  for (const Row& row : rows) {
    all.push_back({{"case", row.extreme.name},
                   {"integrator", row.integrator},
                   {"expected", row.expectation()},
                   {"outcome", to_string(row.result.outcome)},
                   {"as_expected", row.expected()},
                   {"seconds", number_json(row.result.seconds)},
                   {"message", row.result.message}});
  }
  return all;
}

ExitCode run_extreme_study(const StudyOptions& options) {
  const StudyFolder folder = open_study_folder(options, {{"extremes.csv", "extremes.json"}});
  using Align = Table::Align;
  std::vector<Table::Column> columns = {{"case", Align::left}};
  for (const auto& [integrator, implicit] : extreme_integrators) {
    columns.push_back({integrator, Align::left});
  }
  Table table(columns);
  std::vector<Row> rows;
  std::size_t unexpected = 0;
  for (const ExtremeCase& extreme : extreme_cases()) {
    if (options.is_short && extreme.large) continue;
    std::vector<std::string> cells = {extreme.name};
    for (const auto& [integrator, implicit] : extreme_integrators) {
      throw_if_interrupted();
      rows.push_back({extreme, integrator, implicit, run_extreme(extreme, integrator)});
      unexpected += rows.back().expected() ? 0U : 1U;
      cells.push_back(cell(rows.back()));
    }
    table.add_row(cells);
  }
  fmt::print("{}\n{} cases, each with {} integrators; {} not as expected\n", table.text(),
             rows.size() / extreme_integrators.size(), extreme_integrators.size(), unexpected);
  folder.write("extremes.csv", csv_text(rows));
  nlohmann::json json = study_head(options);
  json["cases"] = rows_json(rows);
  folder.write("extremes.json", json.dump(2) + '\n');
  fmt::print("{}\n", folder.path().string());
  return unexpected == 0 ? ExitCode::done : ExitCode::check_failed;
}

}  // namespace

void add_extreme_study(CLI::App& study, Action& action, std::span<const std::string> command_line) {
  const auto options = std::make_shared<StudyOptions>();
  CLI::App* command = study.add_subcommand(
      "extremes", "Run extreme scenes, and compare each outcome with what was expected");
  add_study_options(*command, *options, command_line, "Without those that take long");
  command->callback(
      [options, &action] { action = [options] { return run_extreme_study(*options); }; });
}

}  // namespace pneuma::app

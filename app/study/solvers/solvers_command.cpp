// pneuma study solvers: its options, and what it leaves.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/host/timing_conditions.h"
#include "app/record/provenance.h"
#include "app/study/error/conclusions.h"
#include "app/study/error/error_report.h"
#include "app/study/error/sundials.h"
#include "app/study/report_text.h"
#include "app/study/solvers/solver_cases.h"
#include "app/study/study_command.h"
#include "app/study/study_folder.h"
#include "app/study/study_options.h"
#include "app/terminal/common_options.h"
#include "app/terminal/progress.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

struct SolversArguments : StudyOptions {
  std::optional<int> vertices;
  bool quiet = false;
};

Table ratios_table() {
  constexpr auto left = Table::Align::left, right = Table::Align::right;
  constexpr const char* peers = "SUNDIALS, given the same forces";
  return Table({{"sphere of\nvertices, motion", left},
                {"error"},
                {"method", left, "ours"},
                {"step, s", right, "ours"},
                {"us", right, "ours"},
                {"method", left, peers},
                {"tolerance", right, peers},
                {"us", right, peers},
                {"SUNDIALS /\nours"}});
}

std::vector<std::string> cells_of(const std::optional<ErrorRun>& run) {
  if (!run) return {"-", "-", "-"};
  return {run->method,
          run->ours ? fmt::format("1/{}", run->steps_per_second)
                    : fmt::format("{:.1e}", run->tolerance),
          readable(1e6 * run->run_time)};
}

void add_rows(const ErrorStudy& study, Table& table) {
  for (const double error : compared_errors) {
    const Choice choice = choose(study, error);
    std::vector<std::string> cells = {study.name, power_of_ten(error)};
    for (const auto& run : {choice.ours, choice.peer}) {
      for (std::string& cell : cells_of(run)) cells.push_back(std::move(cell));
    }
    cells.push_back(choice.ratio() ? fmt::format("{:.2f}x", *choice.ratio()) : "-");
    table.add_row(std::move(cells));
  }
}

std::string shortfalls_text(const ErrorStudy& study) {
  std::string text;
  for (const std::string& sentence : shortfalls(study)) {
    text += list_item(fmt::format("{}: {}", study.name, sentence));
  }
  return text;
}

std::vector<SolverCase> wanted_cases(const SolversArguments& typed) {
  std::vector<SolverCase> cases = solver_cases(typed.is_short);
  std::erase_if(cases, [&](const SolverCase& one) {
    return typed.vertices && one.vertices != *typed.vertices;
  });
  return cases;
}

StudyFiles files_of(const std::vector<SolverCase>& cases) {
  StudyFiles files = {{"solvers.json"}};
  for (const SolverCase& one : cases) {
    files.files.insert(files.files.end(),
                       {one.scene.name + "_runs.csv", one.scene.name + "_ratios.csv"});
    files.diagrams.push_back(one.scene.name);
  }
  return files;
}

ExitCode run_solvers_study(const SolversArguments& typed) {
  const std::vector<SolverCase> cases = wanted_cases(typed);
  const StudyFolder folder = open_study_folder(typed, files_of(cases));
  Progress progress(progress_style(typed.quiet));
  // Before anything is measured, which is load itself.
  const std::vector<std::string> warnings = timing_warnings(timing_conditions());
  nlohmann::json json = study_head(typed);
  json.update({{"sundials", sundials_version()}, {"warnings", warnings}});
  Table table = ratios_table();
  std::string behind;
  for (const SolverCase& one : cases) {
    const auto say = [&](const std::string& what) {
      progress.show(fmt::format("{}: {}", one.scene.name, what));
    };
    const ErrorStudy study = study_errors(one.scene, one.options, say);
    add_rows(study, table);
    behind += shortfalls_text(study);
    json["cases"].push_back(error_json(study));
    folder.write(study.name + "_runs.csv", runs_csv(study));
    folder.write(study.name + "_ratios.csv", ratios_csv(study));
    write_diagram(folder, study.name, work_diagram(study));
  }
  folder.write("solvers.json", json.dump(2) + '\n');
  fmt::print("{}{}{}SUNDIALS {}.\n{}", table.text(), behind, provenance_text(json["date"]),
             sundials_version(), warnings_text(warnings));
  return ExitCode::done;
}

}  // namespace

void add_solvers_study(CLI::App& study, Action& action, std::span<const std::string> command_line) {
  const auto typed = std::make_shared<SolversArguments>();
  CLI::App* command = study.add_subcommand(
      "solvers", "Our explicit integrators beside those of SUNDIALS, from 58 to 10,242 vertices");
  command->add_option("--vertices", typed->vertices, "Only the sphere of so many [all of them]")
      ->type_name("N")
      ->check(CLI::IsMember({58, 162, 642, 2562, 10242}));
  add_study_options(*command, *typed, command_line, "The coarsest sphere alone: seconds");
  add_quiet_option(*command, typed->quiet);
  command->callback([typed, &action] { action = [typed] { return run_solvers_study(*typed); }; });
}

}  // namespace pneuma::app

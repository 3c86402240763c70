// pneuma study accuracy: its options, and what it leaves.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/host/errors.h"
#include "app/host/timing_conditions.h"
#include "app/record/provenance.h"
#include "app/study/accuracy/accuracy_study.h"
#include "app/study/csv.h"
#include "app/study/report_text.h"
#include "app/study/study_command.h"
#include "app/study/study_folder.h"
#include "app/study/study_options.h"
#include "app/terminal/common_options.h"
#include "app/terminal/progress.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

struct StudyAccuracyArguments : StudyOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> overrides;
  bool quiet = false;
};

using Status = ErrorRun::Status;

std::string error_reached(const AccuracyRow& row) {
  if (row.run.status != Status::stable) return std::string(to_string(row.run.status));
  const bool missed = !row.asked_for.empty() && !row.is_reached();
  return fmt::format("{:.1e}{}", error_of(row.run), missed ? " (missed)" : "");
}

std::string table_of(const std::vector<AccuracyStudy>& studies) {
  Table table({{"scene", Table::Align::left},
               {"compared\nuntil, s"},
               {"known\nto"},
               {"asked for", Table::Align::left},
               {"chosen", Table::Align::left},
               {"step, s"},
               {"error"},
               {"us"},
               {"us / the\nscene's own"}});
  for (const AccuracyStudy& study : studies) {
    for (const AccuracyRow& row : study.rows) {
      table.add_row({study.name, fmt::format("{:.4g}", study.seconds),
                     fmt::format("{:.0e}", study.uncertainty),
                     row.asked_for.empty() ? "the scene's own" : row.asked_for, row.run.method,
                     fmt::format("1/{}", row.run.steps_per_second), error_reached(row),
                     readable(1e6 * row.run.run_time),
                     fmt::format("{:.2f}", row.run.run_time / study.rows.front().run.run_time)});
    }
  }
  return table.text();
}

std::string accuracy_csv(const std::vector<AccuracyStudy>& studies) {
  Csv csv({"scene", "seconds", "uncertainty", "asked_for", "method", "steps_per_second", "outcome",
           "error", "run_time_s_per_simulated_s"});
  for (const AccuracyStudy& study : studies) {
    for (const AccuracyRow& row : study.rows) {
      csv.add_row({csv_cell(study.name), csv_cell(study.seconds), csv_cell(study.uncertainty),
                   csv_cell(row.asked_for), csv_cell(row.run.method),
                   csv_cell(row.run.steps_per_second),
                   csv_cell(std::string(to_string(row.run.status))), csv_cell(error_of(row.run)),
                   csv_cell(row.run.run_time)});
    }
  }
  return csv.text();
}

nlohmann::json accuracy_json(const AccuracyStudy& study) {
  nlohmann::json rows = nlohmann::json::array();
  for (const AccuracyRow& row : study.rows) {
    rows.push_back({{"asked_for", row.asked_for},
                    {"method", row.run.method},
                    {"steps_per_second", row.run.steps_per_second},
                    {"outcome", std::string(to_string(row.run.status))},
                    {"error", error_of(row.run)},
                    {"run_time_s_per_simulated_s", row.run.run_time}});
  }
  return {{"scene", study.name},
          {"seconds", study.seconds},
          {"uncertainty", study.uncertainty},
          {"max_contacts", study.max_contacts},
          {"rows", std::move(rows)}};
}

std::string contacts_of(const std::vector<AccuracyStudy>& studies) {
  std::string text;
  for (const AccuracyStudy& study : studies) text += contacts_text(study) + '\n';
  return text;
}

AccuracyOptions options_of(const StudyAccuracyArguments& typed) {
  if (!typed.is_short) return {};
  return {.seconds = 0.4, .finest_steps_per_second = 1920, .repeats = 2};
}

ExitCode run_accuracy_study(const StudyAccuracyArguments& typed) {
  const StudyFolder folder = open_study_folder(typed, {{"accuracy.json", "accuracy.csv"}});
  Progress progress(progress_style(typed.quiet));
  // Before anything is measured, which is load itself.
  std::vector<std::string> warnings = timing_warnings(timing_conditions());
  std::vector<AccuracyStudy> studies;
  ExitCode code = ExitCode::done;
  for (const std::string& name : typed.scenes) {
    const auto say = [&](const std::string& what) {
      progress.show(fmt::format("{}: {}", name, what));
    };
    try {
      studies.push_back(study_accuracy(name, typed.overrides, options_of(typed), say));
    } catch (const DivergenceError& error) {  // the other scenes are still worth measuring
      warnings.push_back(fmt::format("{} is missing: {}", name, error.what()));
      code = ExitCode::diverged;
    }
  }
  nlohmann::json json = study_head(typed);
  json.update({{"warnings", warnings}, {"scenes", nlohmann::json::array()}});
  for (const AccuracyStudy& study : studies) json["scenes"].push_back(accuracy_json(study));
  folder.write("accuracy.json", json.dump(2) + '\n');
  folder.write("accuracy.csv", accuracy_csv(studies));
  fmt::print("{}us: microseconds of processor time per simulated second.\n{}{}{}",
             table_of(studies), contacts_of(studies), provenance_text(json["date"]),
             warnings_text(warnings));
  return code;
}

}  // namespace

void add_accuracy_study(CLI::App& study, Action& action,
                        std::span<const std::string> command_line) {
  const auto typed = std::make_shared<StudyAccuracyArguments>();
  CLI::App* command = study.add_subcommand(
      "accuracy", "What --accuracy chooses for scenes, the errors that it has and what it costs");
  command->add_option("scene", typed->scenes, "Scene files or names")
      ->required()
      ->type_name("SCENE");
  add_override_option(*command, typed->overrides);
  add_study_options(*command, *typed, command_line, "Less time: to see that it works");
  add_quiet_option(*command, typed->quiet);
  command->callback([typed, &action] { action = [typed] { return run_accuracy_study(*typed); }; });
}

}  // namespace pneuma::app

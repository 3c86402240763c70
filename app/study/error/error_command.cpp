// pneuma study error: which integrator, at which step, for which error.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "app/host/errors.h"
#include "app/host/timing_conditions.h"
#include "app/record/provenance.h"
#include "app/study/error/error_report.h"
#include "app/study/error/samples.h"
#include "app/study/error/sundials.h"
#include "app/study/report_text.h"
#include "app/study/study_command.h"
#include "app/study/study_folder.h"
#include "app/study/study_parts.h"
#include "app/terminal/common_options.h"
#include "app/terminal/number_text.h"
#include "app/terminal/progress.h"
#include "scenes/loader/integrator_names.h"

namespace pneuma::app {
namespace {

/// The options as they were typed.
struct ErrorArguments : SplitOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> overrides;
  FlightOptions flight;
  std::optional<double> seconds;
  std::optional<int> repeats;
  std::vector<std::string> integrators;
  std::vector<int> steps_per_second;
  bool json = false;
  bool quiet = false;
};

CLI::Validator is_whole_number_of_samples() {
  return {[](const std::string& typed) {
            int steps = 0;
            std::from_chars(typed.data(), typed.data() + typed.size(), steps);
            return steps % samples_per_second == 0
                       ? std::string()
                       : fmt::format("{} is no multiple of {}, at which motions are compared",
                                     typed, samples_per_second);
          },
          "", "SAMPLES"};
}

ErrorOptions sweep(const ErrorArguments& typed) {
  ErrorOptions options = typed.is_short ? short_sweep() : full_sweep();
  options.flight.are_options = true;
  options.flight.body = typed.flight.body;
  options.flight.free_flight = typed.flight.free_flight;
  options.flight.tumbling = typed.flight.tumbling;
  options.flight.seconds = typed.seconds.value_or(options.flight.seconds);
  options.repeats = typed.repeats.value_or(options.repeats);
  for (const auto& [integrator, name] : scenes::integrator_names()) {
    if (std::ranges::count(typed.integrators, name) > 0) options.integrators.push_back(integrator);
  }
  if (!typed.integrators.empty()) options.tolerances.clear();
  if (!typed.steps_per_second.empty()) {
    const std::set<int> ascending(typed.steps_per_second.begin(), typed.steps_per_second.end());
    options.steps_per_second.assign(ascending.begin(), ascending.end());
  }
  return options;
}

/// A scene is one part, because its runs' times are compared.
nlohmann::json measure_scene(const scenes::Scene& scene, const ErrorOptions& options,
                             const std::vector<std::string>& warnings, Progress& progress) {
  const auto say = [&](const std::string& what) {
    progress.show(fmt::format("{}: {}", scene.name, what));
  };
  nlohmann::json measured = {
      {"name", scene.name}, {"machine", machine_json()}, {"warnings", warnings}};
  try {
    const ErrorStudy study = study_errors(scene, options, say);
    measured.update(
        {{"scene", error_json(study)},
         {"text", error_text(study)},
         {"csv",
          {{study.name + "_runs", runs_csv(study)}, {study.name + "_ratios", ratios_csv(study)}}},
         {"diagrams",
          {{study.name + "_work", gnuplot_script(work_diagram(study), study.name + "_work")},
           {study.name + "_step", gnuplot_script(step_diagram(study), study.name + "_step")}}}});
  } catch (const DivergenceError& error) {  // the other scenes are still worth measuring
    measured["missing"] = error.what();
  }
  return measured;
}

StudyFiles files_of(const std::vector<scenes::Scene>& scenes, const std::string& body) {
  StudyFiles files = {{"error.json"}};
  for (const scenes::Scene& scene : scenes) {
    const std::string name = study_name(scene, body);
    files.files.insert(files.files.end(), {name + "_runs.csv", name + "_ratios.csv"});
    files.diagrams.insert(files.diagrams.end(), {name + "_work", name + "_step"});
  }
  return files;
}

/// What has been found.
struct Findings {
  nlohmann::json scenes = nlohmann::json::array();
  std::string text;
  std::vector<std::string> warnings;
  ExitCode code = ExitCode::done;
};

void add_warning(Findings& findings, const std::string& warning) {
  if (std::ranges::count(findings.warnings, warning) == 0) findings.warnings.push_back(warning);
}

void add_scene(const nlohmann::json& measured, const StudyFolder& folder, Findings& findings) {
  for (const std::string warning : measured["warnings"]) add_warning(findings, warning);
  const std::string name = measured["name"];
  if (measured["machine"]["cpu"] != machine().cpu) {
    add_warning(findings, fmt::format("{} was measured on another machine: {}", name,
                                      measured["machine"]["cpu"].get<std::string>()));
  }
  if (measured.contains("missing")) {
    add_warning(findings,
                fmt::format("{} is missing: {}", name, measured["missing"].get<std::string>()));
    findings.code = ExitCode::diverged;
    return;
  }
  for (const auto& [file, text] : measured["csv"].items()) folder.write(file + ".csv", text);
  for (const auto& [file, script] : measured["diagrams"].items()) {
    write_script(folder, file, script);
  }
  findings.scenes.push_back(measured["scene"]);
  findings.scenes.back()["machine"] = measured["machine"];
  findings.text += measured["text"].get<std::string>() + "\n";
}

void print(const ErrorArguments& typed, const ErrorOptions& options, const StudyFolder& folder,
           const Findings& findings) {
  nlohmann::json report = study_head(typed);
  report.update({{"sundials", sundials_version()},
                 {"repeats", options.repeats},
                 {"warnings", findings.warnings},
                 {"scenes", findings.scenes}});
  const std::string json = report.dump(2) + "\n";
  folder.write("error.json", json);
  if (typed.json) {
    fmt::print("{}", json);
    return;
  }
  fmt::print("{}{}SUNDIALS {}.\n{}", findings.text, provenance_text(report["date"]),
             sundials_version(), warnings_text(findings.warnings));
}

ExitCode study(const ErrorArguments& typed) {
  const std::vector<scenes::Scene> scenes = load_scenes(typed.scenes, typed.overrides);
  const ErrorOptions options = sweep(typed);
  Progress progress(progress_style(typed.quiet));
  // Before anything is measured, which is load itself.
  const std::vector<std::string> warnings = timing_warnings(timing_conditions());
  std::vector<StudyPart> parts;
  for (const scenes::Scene& scene : scenes) {
    parts.push_back({part_name({scene.name}),
                     [&] { return measure_scene(scene, options, warnings, progress); }});
  }
  const auto measured =
      measure_parts(typed, {"error", files_of(scenes, typed.flight.body)}, scenes, parts);
  if (!measured) return ExitCode::done;
  const StudyFolder folder(typed.out);
  Findings findings;
  for (const nlohmann::json& scene : *measured) add_scene(scene, folder, findings);
  progress.say("files in " + folder.path().string());
  print(typed, options, folder, findings);
  return findings.code;
}

}  // namespace

void add_error_study(CLI::App& study_command, Action& action,
                     std::span<const std::string> command_line) {
  const auto typed = std::make_shared<ErrorArguments>();
  CLI::App* command = study_command.add_subcommand(
      "error", "Error against run time of every integrator, and which one to take");
  command->add_option("scene", typed->scenes, "Scene files or names")
      ->required()
      ->type_name("SCENE");
  add_override_option(*command, typed->overrides);
  command->add_option("--body", typed->flight.body, "Only this body of the scene")
      ->type_name("NAME");
  command->add_flag(
      "--free-flight", typed->flight.free_flight,
      "Without ground, boxes, obstacles and contacts; so is a scene in which nothing touches");
  command->add_flag("--tumbling", typed->flight.tumbling,
                    "Start with spin, shear and slack springs");
  command
      ->add_option("--seconds", typed->seconds,
                   "Simulated time, at most the scene's own [1; with --short 0.4]")
      ->type_name("S")
      ->check(number_range(0.1, 3600.0));
  command->add_option("--repeats", typed->repeats, "Of each run, for its time [5; with --short 2]")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  std::vector<std::string> names;
  for (const auto& [_, name] : scenes::integrator_names()) names.emplace_back(name);
  command
      ->add_option("--integrators", typed->integrators,
                   "Only these, and none of SUNDIALS' methods beside them")
      ->type_name("NAME")
      ->check(CLI::IsMember(names));
  command
      ->add_option("--steps", typed->steps_per_second,
                   fmt::format("A second, multiples of {} [{}]", samples_per_second,
                               fmt::join(full_sweep().steps_per_second, " ")))
      ->type_name("N")
      ->check(CLI::Range(samples_per_second, 1'000'000))
      ->check(is_whole_number_of_samples());
  add_split_options(*command, *typed, command_line, "Fewer steps, less time: to see that it works");
  command->add_flag("--json", typed->json, "JSON in place of text");
  add_quiet_option(*command, typed->quiet);
  command->callback([typed, &action] { action = [typed] { return study(*typed); }; });
}

}  // namespace pneuma::app
